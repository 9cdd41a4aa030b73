// Volumes that an optimised build passes in seconds and sanitizers in minutes.

#pragma once

/// Skips the test under sanitizers, saying so: smaller volumes send them through the same code.
#ifdef CRAZE_SANITIZED
#define CRAZE_NEEDS_SPEED GTEST_SKIP() << "takes minutes under sanitizers, which smaller volumes pass through"
#else
#define CRAZE_NEEDS_SPEED static_cast<void>(0)
#endif
