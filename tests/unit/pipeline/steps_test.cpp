#include "craze/pipeline/steps.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/json.hpp"
#include "craze/core/progress.hpp"
#include "craze/io/atomic_file.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <chrono>
#include <thread>

namespace craze::pipeline {
namespace {

namespace fs = std::filesystem;

class Steps : public testing::Test {
protected:
    void SetUp() override
    {
        set_verbosity(Verbosity::quiet);
        fs::remove_all(out);
    }
    void TearDown() override { fs::remove_all(out); }

    std::vector<Step> chain(const std::string& first = "1", const std::string& second = "1")
    {
        return {{"images", first, {}, [this](const fs::path&) { return count("images"); }},
                {"mesh", second, {"images"}, [this](const fs::path&) { return count("mesh"); }},
                {"domain", "1", {"mesh"}, [this](const fs::path& folder) -> Json {
                     if (writes) io::write_text(folder / "elements.csv", did);
                     if (fail) throw ComputationFailed("no");
                     return count("domain");
                 }}};
    }
    Json count(const std::string& name)
    {
        did += name + " ";
        return Json{{"number", 7}};
    }
    std::string did_in(const std::vector<Step>& steps, bool resume)
    {
        did.clear();
        run_steps(steps, out, resume);
        return did;
    }

    fs::path out = fs::temp_directory_path() / ("craze_steps_" + std::to_string(getpid()));
    std::string did;
    bool fail = false, writes = false;
};

TEST_F(Steps, ResumeDoesOnlyWhatChangedAndWhatFollowsFromIt)
{
    EXPECT_EQ(did_in(chain(), true), "images mesh domain ");
    EXPECT_EQ(did_in(chain(), true), "");
    EXPECT_EQ(did_in(chain("1", "2"), true), "mesh domain ");
    EXPECT_EQ(did_in(chain("2", "2"), true), "images mesh domain ");
    EXPECT_EQ(did_in(chain("2", "2"), false), "images mesh domain ");
}

TEST_F(Steps, AFailureKeepsWhatWasFinishedAndResumeGoesOnFromThere)
{
    fail = true;
    EXPECT_THROW(run_steps(chain(), out, false), ComputationFailed);
    EXPECT_TRUE(fs::exists(out / "mesh" / "stamp.json"));
    EXPECT_FALSE(fs::exists(out / "domain" / "stamp.json"));
    fail = false;
    EXPECT_EQ(did_in(chain(), true), "domain ");
}

TEST_F(Steps, ARedoneStepThatFailsBeforeItWritesLeavesItsResults)
{
    writes = true;
    run_steps(chain(), out, false);
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    fail = true, writes = false;
    EXPECT_THROW(run_one(chain(), "domain", out), ComputationFailed);
    fail = false;
    EXPECT_EQ(did_in(chain(), true), "");
}

TEST_F(Steps, AStepMayTakeWhatIsThereButNotNothing)
{
    auto steps = chain();
    steps.back().takes_what_is_there = true;
    EXPECT_THROW(run_one(steps, "domain", out), InvalidInput);
    run_one(steps, "images", out);
    run_one(steps, "domain", out);
    EXPECT_EQ(did, "images domain ");
}

TEST_F(Steps, ARedoneStepThatFailsAfterItWroteIsNoLongerTrusted)
{
    writes = true;
    run_steps(chain(), out, false);
    fail = true;
    EXPECT_THROW(run_one(chain(), "domain", out), ComputationFailed);
    fail = false;
    EXPECT_EQ(did_in(chain(), true), "domain ");
}

TEST_F(Steps, OneStepNeedsTheResultsBeforeIt)
{
    EXPECT_THROW(run_one(chain(), "mesh", out), InvalidInput);
    EXPECT_THROW(run_one(chain(), "loading", out), InvalidInput);
    run_one(chain(), "images", out);
    run_one(chain(), "mesh", out);
    EXPECT_EQ(did, "images mesh ");
    run_one(chain("2"), "mesh", out);
    const auto notices = read_summary(out, "mesh")["notices"];
    ASSERT_EQ(notices.size(), 1U);
    EXPECT_NE(notices[0].get<std::string>().find("other settings"), std::string::npos);
}

TEST_F(Steps, SummariesHoldTheStepsKeysTimeAndMemory)
{
    run_steps(chain(), out, false);
    const Json summary = read_summary(out, "images");
    EXPECT_EQ(summary["number"], 7);
    EXPECT_GE(summary["seconds"], 0.0);
    EXPECT_GT(summary["peak_memory_bytes"], 1'000'000);
    EXPECT_TRUE(read_summary(out, "nothing").is_null());
}

TEST_F(Steps, ADamagedStampIsNotTrusted)
{
    run_steps(chain(), out, false);
    io::write_text(out / "images" / "stamp.json", "{\"key\": ");
    EXPECT_EQ(did_in(chain(), true), "images ");
}

}  // namespace
}  // namespace craze::pipeline
