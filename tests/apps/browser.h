#pragma once
/// Pages in headless Chromium.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "programs/process.h"
#include "support/run_program.h"

namespace roevo::test {

/// Opens a page whose script tells what it found by `tell(value)`, and ends with that. Nothing in it waits
/// for a fixed time, so that it works on a loaded machine, too.
/// @param profile  a folder that the browser may make. @return null after a failure of the test
inline nlohmann::json foundInBrowser(const std::string& page, const std::string& profile,
                                     const std::string& window = "1400,900") {
    const auto run = runProgram(
        "/usr/bin/timeout",
        {"240", findProgram("chromium"), "--headless", "--no-sandbox", "--enable-unsafe-swiftshader",
         "--use-angle=swiftshader", "--user-data-dir=" + profile, "--window-size=" + window,
         "--allow-file-access-from-files", "--enable-logging=stderr", "file://" + page});
    const std::string begin = "FOUND", end = "DNUOF";
    const std::size_t at = run.err.find(begin), last = run.err.find(end);
    if (at == std::string::npos || last == std::string::npos) {
        ADD_FAILURE() << "the page did not come to its end: " << run.all();
        return {};
    }
    return nlohmann::json::parse(run.err.substr(at + begin.size(), last - at - begin.size()));
}

/// The `tell` of foundInBrowser(): a page that is alone in its window may close it, and so ends the browser.
inline const std::string kTell =
    "const tell = found => { console.log('FOUND' + JSON.stringify(found) + 'DNUOF'); window.close(); };\n";

}  // namespace roevo::test
