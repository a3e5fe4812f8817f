#pragma once
#include <string>

namespace roevo {

/// A core of this machine for one run alone, as long as this object lives: no other claim gets it, of
/// whatever program. The last ones first: the first is often the busiest with the system's own work.
class CoreClaim {
  public:
    CoreClaim();
    ~CoreClaim();
    CoreClaim(const CoreClaim&) = delete;
    CoreClaim& operator=(const CoreClaim&) = delete;

    int core() const { return core_; }                   ///< -1: any
    const std::string& fault() const { return fault_; }  ///< why it is any; empty when it is not

  private:
    int core_ = -1, socket_ = -1;
    std::string fault_ = "the system does not tell its cores";
};

}  // namespace roevo
