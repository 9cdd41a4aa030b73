// The crack surface in space, and which way it faces [2.5, Fig. 8].

#include "craze/core/json.hpp"
#include "craze/report/sections.hpp"

namespace craze::report {

void write_mesh(Work& work)
{
    if (!begin_room(work, "mesh", "Crack surface")) return;
    end_room(work, "mesh");
}

}  // namespace craze::report
