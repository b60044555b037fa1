#include "process/process_heap.hpp"

#include <malloc.h>

#include <new>

namespace oval4d::process {

namespace {

// Fixed thresholds of glibc's allocator, in bytes. Without them, glibc would raise its own thresholds step by step, to
// at most these values, when large blocks are freed.
constexpr int kMapThreshold = 32 << 20;  // a block of at least this size is mapped, and unmapped when it is freed
constexpr int kTrimThreshold = 2 * kMapThreshold;

}  // namespace

ProcessHeap::ProcessHeap() {
    mallopt(M_MMAP_THRESHOLD, kMapThreshold);
    mallopt(M_TRIM_THRESHOLD, kTrimThreshold);
    // In a build with a sanitizer, mallopt does not reach glibc's allocator, so the first malloc_trim initializes this
    // allocator. Several threads must not initialize it at once, so the constructor initializes it.
    malloc_trim(0);
}

/// malloc_trim does not return the free memory at the end of a thread's arena. glibc returns this memory only when the
/// thread frees a large block and there is more free memory than the trim threshold. Therefore this function sets the
/// threshold to 0 for a moment, and frees a large block.
void ProcessHeap::returnFreeMemory() {
    mallopt(M_TRIM_THRESHOLD, 0);
    void* const volatile large = ::operator new(1U << 17U);
    ::operator delete(large);
    malloc_trim(0);
    mallopt(M_TRIM_THRESHOLD, kTrimThreshold);
}

}  // namespace oval4d::process
