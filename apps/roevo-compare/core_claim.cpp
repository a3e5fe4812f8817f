#include "core_claim.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstddef>
#include <cstdio>

#include "programs/process.h"

namespace roevo {

CoreClaim::CoreClaim() {
    const auto cores = allowedCores();
    for (auto core = cores.rbegin(); core != cores.rend(); ++core) {
        // A name in the abstract name space: no file that could stay or belong to another user, and it goes
        // with the process whatever ends that
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        const int length =
            std::snprintf(address.sun_path + 1, sizeof address.sun_path - 1, "roevo-core-%d", *core);
        const auto size = offsetof(sockaddr_un, sun_path) + 1 + static_cast<std::size_t>(length);
        socket_ = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
        if (socket_ >= 0 &&
            bind(socket_, reinterpret_cast<const sockaddr*>(&address), static_cast<socklen_t>(size)) == 0) {
            core_ = *core;
            fault_.clear();
            return;
        }
        if (socket_ >= 0) close(socket_);
        socket_ = -1;
        fault_ = "every core has a run of roevo-compare already";
    }
}

CoreClaim::~CoreClaim() {
    if (socket_ >= 0) close(socket_);
}

}  // namespace roevo
