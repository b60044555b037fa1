#include "fields/array/mapped_file.hpp"

#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <mutex>
#include <system_error>
#include <utility>

namespace oval4d::fields {

namespace {

/// An entry in the list of mapped files, in which the handler of SIGBUS looks for the address of a fault. A free entry
/// has a `begin` of 0. The handler reads only atomic members, because a signal handler may not wait for a mutex.
struct MappedFileRange {
    std::atomic<std::uintptr_t> begin = 0;
    std::atomic<std::size_t> size = 0;
    std::atomic<int> protection = 0;
    std::atomic<bool> lost = false;
    timespec modified{};  // the file's time of modification when it was mapped; the handler does not read it
};
static_assert(std::atomic<std::uintptr_t>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

constexpr std::size_t kMaxFiles = 4096;
std::array<MappedFileRange, kMaxFiles> mappedRanges;  // global, because a signal handler has no arguments of its own
std::mutex mappedRangesMutex;                         // locked while a thread takes or frees an entry

void onBusError(int number, siginfo_t* info, void* /*context*/) {
    const int fault = errno;
    const auto address = reinterpret_cast<std::uintptr_t>(info->si_addr);
    for (MappedFileRange& range : mappedRanges) {
        const std::uintptr_t begin = range.begin.load();
        if (begin == 0 || address < begin || address - begin >= range.size.load()) continue;
        // One mapping of zeros replaces the whole file, because a process may have only a limited number of mappings. A
        // system call is safe in a signal handler. mmap() is not called, because ThreadSanitizer replaces it, and
        // reports a data race with the threads that read the file.
        const long zeros = syscall(SYS_mmap, begin, range.size.load(), range.protection.load(),
                                   MAP_FIXED | MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
        if (zeros == -1) break;
        range.lost = true;
        errno = fault;
        return;
    }
    std::signal(number, SIG_DFL);  // the failed instruction is repeated, and ends the process
}

void installBusErrorHandler() {
    static std::once_flag once;
    std::call_once(once, [] {
        struct sigaction action{};
        action.sa_sigaction = onBusError;
        action.sa_flags = SA_SIGINFO;
        sigemptyset(&action.sa_mask);
        sigaction(SIGBUS, &action, nullptr);
    });
}

}  // namespace

FileHandle::~FileHandle() {
    if (descriptor_ >= 0) close(descriptor_);
}

std::size_t FileHandle::size() const {
    struct stat status{};
    return fstat(descriptor_, &status) == 0 && status.st_size > 0 ? static_cast<std::size_t>(status.st_size) : 0;
}

Result<std::shared_ptr<MappedFile>> MappedFile::mapAs(MappingAccess access, int descriptor,
                                                      std::shared_ptr<const FileHandle> file) {
    struct stat status{};
    if (fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode))
        return Error{ErrorCode::bad_field, "not a regular file"};
    if (status.st_size <= 0) return Error{ErrorCode::bad_field, "the file is empty"};
    const auto size = static_cast<std::size_t>(status.st_size);
    const int protection = access == MappingAccess::write ? PROT_READ | PROT_WRITE : PROT_READ;
    installBusErrorHandler();
    const std::lock_guard lock(mappedRangesMutex);
    std::size_t entry = 0;
    while (entry < kMaxFiles && mappedRanges[entry].begin != 0) ++entry;
    if (entry == kMaxFiles)
        return Error{ErrorCode::too_large, "more than " + std::to_string(kMaxFiles) + " files are open"};
    void* const at = mmap(nullptr, size, protection, MAP_SHARED, descriptor, 0);
    if (at == MAP_FAILED && errno == ENOMEM)
        return Error{ErrorCode::too_large, "the file is larger than the memory that may be used to read it"};
    if (at == MAP_FAILED)
        return Error{ErrorCode::internal, "the file cannot be mapped: " + std::generic_category().message(errno)};
    MappedFileRange& range = mappedRanges[entry];
    range.size = size;
    range.protection = protection;
    range.lost = false;
    range.modified = status.st_mtim;
    range.begin = reinterpret_cast<std::uintptr_t>(at);
    return std::shared_ptr<MappedFile>(new MappedFile(static_cast<std::byte*>(at), size, std::move(file), entry));
}

Result<MappedFilePtr> MappedFile::map(std::shared_ptr<const FileHandle> file) {
    const int descriptor = file->descriptor();
    auto mapped = mapAs(MappingAccess::read, descriptor, std::move(file));
    if (!mapped) return mapped.error();
    return MappedFilePtr(std::move(*mapped));
}

Result<std::shared_ptr<MappedFile>> MappedFile::mapForWriting(std::shared_ptr<const FileHandle> file) {
    const int descriptor = file->descriptor();
    return mapAs(MappingAccess::write, descriptor, std::move(file));
}

Result<MappedFilePtr> MappedFile::map(int descriptor) {
    auto mapped = mapAs(MappingAccess::read, descriptor, nullptr);
    if (!mapped) return mapped.error();
    return MappedFilePtr(std::move(*mapped));
}

MappedFile::~MappedFile() {
    const std::lock_guard lock(mappedRangesMutex);
    mappedRanges[entry_].begin = 0;
    munmap(at_, size_);
}

bool MappedFile::isLost() const {
    const MappedFileRange& range = mappedRanges[entry_];
    if (range.lost || !file_) return range.lost;
    // Any modification of the file since it was mapped counts as a loss, even if the file has its full size now.
    // Someone may have shortened and then restored it. In between, another process of the server that has mapped the
    // file may have read zeros.
    struct stat status{};
    return fstat(file_->descriptor(), &status) != 0 || static_cast<std::size_t>(status.st_size) < size_ ||
           status.st_mtim.tv_sec != range.modified.tv_sec || status.st_mtim.tv_nsec != range.modified.tv_nsec;
}

void MappedFile::releasePages() const {
    // The mapping is shared, so this call only removes the pages from the page table. The system still writes changed
    // pages to the file.
    if (!isLost()) madvise(at_, size_, MADV_DONTNEED);
}

}  // namespace oval4d::fields
