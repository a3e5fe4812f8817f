#include "browser.h"
#include "render_page_fixture.h"

namespace roevo {
namespace {

using nlohmann::json;
using test::RenderPage;

TEST_F(RenderPage, WorksInABrowser) {
    if (findProgram("chromium").empty())
        GTEST_SKIP() << "no chromium here (apt-get install chromium): the page is not tried in a browser";
    writeTumTrajectory(folder_ / "truth.txt", test::circle(1.005));
    writeTumTrajectory(folder_ / "other.txt", test::circle(1.3));
    map_.push_back(test::lineOf({-3, 0, -7}, {3, 0, -7}, 100));  // behind all else, but of the room
    map_.back().colours.assign(100, {20, 250, 20});
    savePly(result() + "/map.ply", map_);
    ASSERT_EQ(
        render({"--ground-truth", folder_ / "truth.txt", "--trajectory", "</b>x=" + (folder_ / "other.txt")})
            .exit_code,
        0);
    std::string html = test::readFile(page());
    const std::string user = test::readFile(ROEVO_SOURCE_DIR "/tests/apps/page_user.js");
    html.replace(html.rfind("</body>"), 7, "<script>" + test::kTell + user + "</script></body>");
    test::writeFile(page(), html);
    const json found = test::foundInBrowser(page(), folder_ / "profile", "800,600");
    if (found.is_null()) return;
    const auto number = [&](const char* key) { return found[key].get<int>(); };
    EXPECT_GT(number("edges"), 300) << found;
    EXPECT_GT(number("path"), 50) << found;
    EXPECT_GT(number("behind"), 80) << "the first view holds the whole map" << found;
    EXPECT_EQ(number("hidden"), 0) << found;
    EXPECT_EQ(number("shown"), number("edges")) << found;
    EXPECT_LT(number("path_by_error"), number("path") / 5) << found;
    for (const char* step : {"turned", "zoomed", "touched"}) EXPECT_GT(number(step), 300) << step << found;
    EXPECT_EQ(found["moment"], "3.00 s · error 0.5 cm");
    EXPECT_EQ(found["names"], json({"final", "live", "</b>x", "ground truth"}));
    EXPECT_EQ(number("loaded"), 0) << found;
    EXPECT_LE(number("overflow"), 0) << found;
}

TEST_F(RenderPage, OffersNoColoursByErrorWithoutErrors) {
    if (findProgram("chromium").empty())
        GTEST_SKIP() << "no chromium here (apt-get install chromium): the page is not tried in a browser";
    ASSERT_EQ(render().exit_code, 0);
    std::string html = test::readFile(page());
    const std::string user =
        "tell({display: getComputedStyle(document.getElementById('colouring')).display});";
    html.replace(html.rfind("</body>"), 7, "<script>" + test::kTell + user + "</script></body>");
    test::writeFile(page(), html);
    const json found = test::foundInBrowser(page(), folder_ / "profile", "800,600");
    if (found.is_null()) return;
    EXPECT_EQ(found["display"], "none");
}

}  // namespace
}  // namespace roevo
