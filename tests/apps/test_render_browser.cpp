#include "programs/process.h"
#include "render_page_fixture.h"

namespace roevo {
namespace {

using nlohmann::json;
using test::RenderPage;

TEST_F(RenderPage, WorksInABrowser) {
    const std::string chromium = findProgram("chromium");
    if (chromium.empty())
        GTEST_SKIP() << "no chromium here (apt-get install chromium): the page is not tried in a browser";
    writeTumTrajectory(folder_ / "truth.txt", test::circle(1.1));
    writeTumTrajectory(folder_ / "other.txt", test::circle(1.3));
    ASSERT_EQ(
        render({"--ground-truth", folder_ / "truth.txt", "--trajectory", "</b>x=" + (folder_ / "other.txt")})
            .exit_code,
        0);
    std::string html = test::readFile(page());
    const std::string user = test::readFile(ROEVO_SOURCE_DIR "/tests/apps/page_user.js");
    html.replace(html.rfind("</body>"), 7, "<script>" + user + "</script></body>");
    test::writeFile(page(), html);
    const auto run = test::runProgram(
        "/usr/bin/timeout",
        {"60", chromium, "--headless", "--no-sandbox", "--enable-unsafe-swiftshader",
         "--use-angle=swiftshader", "--user-data-dir=" + (folder_ / "profile"), "--window-size=800,600",
         "--virtual-time-budget=5000", "--dump-dom", "file://" + page()});
    const std::string begin = "<pre id=\"found\">";
    const std::size_t at = run.out.find(begin);
    ASSERT_NE(at, std::string::npos) << "the page did not come to its end: " << run.err;
    const json found =
        json::parse(run.out.substr(at + begin.size(), run.out.find("</pre>", at) - at - begin.size()));
    const auto number = [&](const char* key) { return found[key].get<int>(); };
    EXPECT_GT(number("edges"), 300) << found;
    EXPECT_GT(number("path"), 50) << found;
    EXPECT_EQ(number("hidden"), 0) << found;
    EXPECT_EQ(number("shown"), number("edges")) << found;
    EXPECT_LT(number("path_by_error"), number("path") / 5) << found;
    for (const char* step : {"turned", "zoomed", "touched"}) EXPECT_GT(number(step), 300) << step << found;
    EXPECT_EQ(found["moment"], "3.00 s · error 10 cm");
    EXPECT_EQ(found["names"], json({"final", "live", "&lt;/b&gt;x", "ground truth"}))
        << "text, as dump-dom escapes it";
    EXPECT_EQ(number("loaded"), 0) << found;
    EXPECT_LE(number("overflow"), 0) << found;
}

}  // namespace
}  // namespace roevo
