// The fuzzers' targets on their seeds and on a few mutations of these, always the same ones: that they go on
// working, and that what was found once stays mended. Finding more takes the preset fuzz
// (docs/developing.md).
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>

#include "fuzz/targets.h"

namespace roevo::fuzz {
namespace {

class Mutations {
  public:
    explicit Mutations(std::vector<std::string> seeds) : seeds_(std::move(seeds)) {}

    std::string next() {
        std::string bytes = seeds_[below(seeds_.size())];
        for (std::size_t changes = 1 + below(4); changes > 0; changes--) change(bytes);
        return bytes;
    }

  private:
    std::size_t below(std::size_t end) { return end > 0 ? random_() % end : 0; }

    void change(std::string& bytes) {
        const std::size_t at = below(bytes.size()), length = std::min(below(32), bytes.size() - at);
        const std::string& other = seeds_[below(seeds_.size())];
        switch (below(6)) {
            case 0:
                bytes.erase(at, length);
                break;
            case 1:
                bytes.insert(at, bytes.substr(at, length));
                break;
            case 2:
                bytes.insert(at, other.substr(below(other.size()), length));
                break;
            case 3:
                std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), length,
                            below(2) ? '\xFF' : '\0');
                break;
            case 4:
                if (below(8) == 0) bytes.resize(at);
                break;
            default:
                if (!bytes.empty()) bytes[at] = static_cast<char>(random_());
        }
    }

    std::vector<std::string> seeds_;
    std::mt19937 random_{1};
};

class Fuzz : public ::testing::TestWithParam<Target> {};

std::string hex(const std::string& bytes) {
    constexpr std::size_t kMost = 400;
    std::string text;
    char digits[3];
    for (const char byte : bytes.substr(0, kMost)) {
        std::snprintf(digits, sizeof digits, "%02x", static_cast<unsigned char>(byte));
        text += digits;
    }
    return text + (bytes.size() > kMost ? "…" : "");
}

void expectFine(const Target& target, const std::string& bytes) {
    try {
        target.run(bytes);
    } catch (const std::exception& error) {
        ADD_FAILURE() << target.name << ": " << error.what() << "\n" << hex(bytes);
    }
}

TEST_P(Fuzz, SeedsAndMutationsKeepThePromises) {
    const char* longer = std::getenv("ROEVO_FUZZ_SECONDS");  // for each target
    const int mutations = longer ? std::numeric_limits<int>::max() : 300;
    // So many of them as fit: no test of speed
    const std::chrono::duration<double> time(longer ? std::atof(longer) : 0.8);
    const auto seeds = GetParam().seeds();
    ASSERT_FALSE(seeds.empty());
    for (const std::string& seed : seeds) expectFine(GetParam(), seed);
    for (const std::string bytes : {"", "x", "\n"}) expectFine(GetParam(), bytes);
    Mutations changed(seeds);
    const auto begin = std::chrono::steady_clock::now();
    int run = 0;
    for (; run < mutations && std::chrono::steady_clock::now() - begin < time; run++)
        expectFine(GetParam(), changed.next());
    std::printf("%s: %d mutations of %zu seeds\n", GetParam().name, run, seeds.size());
}

INSTANTIATE_TEST_SUITE_P(Targets, Fuzz, ::testing::ValuesIn(targets()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace roevo::fuzz
