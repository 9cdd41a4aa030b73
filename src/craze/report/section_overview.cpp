#include "craze/report/sections.hpp"

namespace craze::report {

void write_overview(Work& work)
{
    work.page.section("results", "Results");
    if (work.folder.run().is_null() && !work.folder.has("images") && !work.folder.has("domain"))
        work.page.remark("No room has left results in this folder yet.");
}

}  // namespace craze::report
