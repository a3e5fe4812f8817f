#pragma once
#include <cstdlib>
#include <optional>
#include <string>

namespace roevo::test {

/// While it is alive, this environment variable has this value, or none.
class WithEnvironment {
  public:
    WithEnvironment(const char* name, const std::optional<std::string>& value) : name_(name) {
        if (const char* before = std::getenv(name)) before_ = before;
        set(value);
    }
    ~WithEnvironment() { set(before_); }
    WithEnvironment(const WithEnvironment&) = delete;
    WithEnvironment& operator=(const WithEnvironment&) = delete;

    void set(const std::optional<std::string>& value) const {
        if (value)
            setenv(name_, value->c_str(), 1);
        else
            unsetenv(name_);
    }

  private:
    const char* name_;
    std::optional<std::string> before_;
};

}  // namespace roevo::test
