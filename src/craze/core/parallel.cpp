#include "craze/core/parallel.hpp"

namespace craze {

namespace {
int chosen = 0;
}

void set_threads(int threads) { chosen = threads; }
int threads() { return chosen > 0 ? chosen : omp_get_num_procs(); }

}  // namespace craze
