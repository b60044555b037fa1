#include "process/heap.hpp"

#include <malloc.h>

#include <new>

namespace oval4d::process {

namespace {

// In bytes. glibc would reach these values by itself after seeing blocks as large.
constexpr int kMapThreshold = 32 << 20;  // larger blocks are mapped one by one, and unmapped when they are freed
constexpr int kTrimThreshold = 2 * kMapThreshold;

}  // namespace

Heap::Heap() {
    mallopt(M_MMAP_THRESHOLD, kMapThreshold);
    mallopt(M_TRIM_THRESHOLD, kTrimThreshold);
}

/// malloc_trim leaves the end of a thread's arena, however large it is. glibc cuts that off, if it exceeds the trim
/// threshold, when the thread frees a large block.
void Heap::returnFreeMemory() {
    mallopt(M_TRIM_THRESHOLD, 0);
    void* const volatile large = ::operator new(1U << 17U);
    ::operator delete(large);
    malloc_trim(0);
    mallopt(M_TRIM_THRESHOLD, kTrimThreshold);
}

}  // namespace oval4d::process
