#pragma once

namespace oval4d::process {

/// The heap of this process, which the allocator of glibc manages. The constructor configures the allocator. Therefore
/// main() must construct the only object of this class before the program allocates much memory.
class ProcessHeap {
  public:
    ProcessHeap();
    ProcessHeap(const ProcessHeap&) = delete;
    ProcessHeap& operator=(const ProcessHeap&) = delete;

    /// Returns free memory to the operating system. Takes some milliseconds. Thread-safe.
    void returnFreeMemory();
};

}  // namespace oval4d::process
