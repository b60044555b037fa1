#pragma once

namespace oval4d::process {

/// The heap of this process, which glibc's allocator manages. The constructor configures the allocator, so main() must
/// construct the only object before the program allocates much memory.
class ProcessHeap {
  public:
    ProcessHeap();
    ProcessHeap(const ProcessHeap&) = delete;
    ProcessHeap& operator=(const ProcessHeap&) = delete;

    /// Returns free memory to the operating system, which takes milliseconds. Thread-safe.
    void returnFreeMemory();
};

}  // namespace oval4d::process
