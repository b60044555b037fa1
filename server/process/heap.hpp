#pragma once

namespace oval4d::process {

/// Configures glibc's memory allocator for this process, and returns free memory to the operating system. Construct one
/// object in main(), before the program allocates much memory.
class HeapTrimmer {
  public:
    HeapTrimmer();
    HeapTrimmer(const HeapTrimmer&) = delete;
    HeapTrimmer& operator=(const HeapTrimmer&) = delete;

    /// Returns free memory to the operating system, which takes milliseconds. Thread-safe.
    void returnFreeMemory();
};

}  // namespace oval4d::process
