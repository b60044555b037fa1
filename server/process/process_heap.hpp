#pragma once

namespace oval4d::process {

/// The heap of this process, which the allocator of glibc manages. The constructor configures the allocator. So main()
/// must construct the only object before the program allocates much memory.
class ProcessHeap {
  public:
    ProcessHeap();
    ProcessHeap(const ProcessHeap&) = delete;
    ProcessHeap& operator=(const ProcessHeap&) = delete;

    /// Returns free memory to the operating system. Takes some milliseconds. Thread-safe.
    void returnFreeMemory();
};

}  // namespace oval4d::process
