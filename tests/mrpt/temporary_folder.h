#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

namespace roevo::test {

/// A folder for one test, removed with everything in it.
class TemporaryFolder {
  public:
    TemporaryFolder() {
        static int number = 0;
        const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
        path_ = std::filesystem::temp_directory_path() /
                ("roevo_" + std::to_string(::getpid()) + "_" + test->test_suite_name() + "_" + test->name() +
                 "_" + std::to_string(number++));
        std::filesystem::remove_all(path_);
        std::filesystem::create_directories(path_);
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    std::string operator/(const std::string& name) const { return (path_ / name).string(); }
    const std::filesystem::path& path() const { return path_; }

    std::size_t count() const {
        const auto begin = std::filesystem::directory_iterator(path_);
        return static_cast<std::size_t>(std::distance(begin, std::filesystem::directory_iterator()));
    }

  private:
    std::filesystem::path path_;
};

/// What a call throws, as text; "" when it does not throw.
template <class Call>
std::string errorOf(Call&& call) {
    try {
        call();
    } catch (const std::exception& error) {
        return error.what();
    }
    return "";
}

}  // namespace roevo::test
