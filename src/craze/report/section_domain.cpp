// Elements and bonds [3, Figs. 10, 12, 13, 16].

#include "craze/core/json.hpp"
#include "craze/report/sections.hpp"

namespace craze::report {

void write_domain(Work& work)
{
    if (!begin_room(work, "domain", "Discrete domain")) return;
    end_room(work, "domain");
}

}  // namespace craze::report
