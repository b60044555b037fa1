#include "process/process_heap.hpp"

#include <malloc.h>

#include <new>

namespace oval4d::process {

namespace {

// Thresholds of glibc's allocator, in bytes. Setting them keeps glibc from raising its own thresholds when large blocks
// are freed.
constexpr int kMapThreshold = 32 << 20;  // blocks of at least this size are mapped from the system separately
constexpr int kTrimThreshold = 2 * kMapThreshold;

}  // namespace

ProcessHeap::ProcessHeap() {
    mallopt(M_MMAP_THRESHOLD, kMapThreshold);
    mallopt(M_TRIM_THRESHOLD, kTrimThreshold);
    // In a build with a sanitizer, mallopt() does not reach glibc's allocator, so the first call of malloc_trim()
    // initializes the allocator. Several threads must not do this at once. So make the first call here.
    malloc_trim(0);
}

/// malloc_trim() does not return the free memory at the end of a thread's arena. glibc returns this memory only when
/// the thread frees a large block while more memory is free than the trim threshold. So set the threshold to 0 for a
/// moment, and free a large block.
void ProcessHeap::returnFreeMemory() {
    mallopt(M_TRIM_THRESHOLD, 0);
    void* const volatile large = ::operator new(1U << 17U);
    ::operator delete(large);
    malloc_trim(0);
    mallopt(M_TRIM_THRESHOLD, kTrimThreshold);
}

}  // namespace oval4d::process
