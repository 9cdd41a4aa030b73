#include "craze/core/version.hpp"

#include <cstdio>

int main()
{
    std::printf("craze %s\n", craze::version);
    return 0;
}
