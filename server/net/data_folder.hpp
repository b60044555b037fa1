#pragma once
// The folder of arrays that the server offers to all sessions (--data).

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "errors/error.hpp"
#include "fields/array/mapped_file.hpp"
#include "fields/field.hpp"
#include "fields/readers/folder_files.hpp"
#include "file_reading/file_reader_pool.hpp"
#include "net/field_cache_files.hpp"
#include "net/object_store.hpp"
#include "session/load.hpp"

namespace oval4d::net {

/// A folder of arrays, on a disk or in an object store. Each entry is a file, a Zarr folder, or a folder that is a
/// series: its files are the time steps of one array. Clients refer to entries by name; names that begin with a dot or
/// lead outside the folder are refused, and symbolic links are not followed. Sessions that open the same file in the
/// same way, under whatever names, share one copy, until the file changes. Fields that are larger than
/// session::Limits::maxFieldBytes are mapped into memory: from the file in the folder or, if its samples must be
/// converted, from a file of the field cache (see FieldCacheFiles). Thread-safe.
///
/// The entries in an object store are Zarr folders. Fields from a store that are in memory are read again when the
/// metadata of their Zarr folder change; changes of chunks are not noticed.
class DataFolder {
  public:
    /// `folder`: a path, or the address of an object store; empty if the server offers none. `bytes`: the maximum
    /// memory, in bytes, of the fields from the folder, whether or not sessions use them. `fieldCacheFiles` must
    /// outlive the fields. Throws std::runtime_error if the folder cannot be read, and std::invalid_argument if the
    /// address is not valid.
    DataFolder(const std::string& folder, std::size_t bytes, FieldCacheFiles& fieldCacheFiles,
               const ObjectStoreLimits& storeLimits = {});

    /// Reads a file as FileReaderPool::read() does.
    using Reader = std::function<Result<session::ObjectWithWarnings>(
        const session::LoadObject& load, const session::Limits& limits, const file_reading::FileAllocator& allocate)>;

    /// Returns the names of the entries that can be opened, in alphabetical order; at most kMaxNames. Unless
    /// knownNames() has the names, reads the folder, which blocks the calling thread. The names in an object store are
    /// those that its object index.json, a JSON array of strings, lists; without one, there are none.
    std::vector<std::string> names() const;
    /// Returns the names that names() last read from the folder, if it began to read them less than kListedFor ago;
    /// else an empty optional. Returns an empty list if there is no data folder.
    std::optional<std::vector<std::string>> knownNames() const;

    /// Returns the field that `load.dataName` names. If it is not in memory, calls `reader` with a copy of `load` that
    /// contains the opened files. Blocks the calling thread until the field is read, by this thread or by another one
    /// that is already reading the same field. Errors: those of ObjectStore::get(); `not_found` if the folder has no
    /// such file; `too_large` if the field takes more memory or disk space than the limits allow, or if a series has
    /// more than kMaxSeries files; `too_many` if fields in use leave too little memory or disk space; `bad_field` if
    /// the file is not an array, or is found to have changed while it was read; those of `reader`.
    Result<session::ObjectWithWarnings> read(const session::LoadObject& load, const session::Limits& limits,
                                             const Reader& reader);

    /// Returns the memory, in bytes, of all fields from the folder.
    std::size_t bytesInMemory() const;

    /// The maximum number of names that names() returns, and of files in a series.
    static constexpr std::size_t kMaxNames = 1000, kMaxSeries = 1000;
    /// The time for which knownNames() returns names that were read from the folder.
    static constexpr std::chrono::seconds kListedFor{2};

  private:
    using Clock = std::chrono::steady_clock;
    // A file, a Zarr folder or a series that open() has opened.
    struct OpenedEntry {
        std::vector<std::shared_ptr<const fields::FileHandle>> files;
        std::shared_ptr<const fields::FolderFiles> folder;  // the Zarr folder, instead of `files`; else null
        bool series = false;
        std::string version;  // changes when one of `files` changes, or the metadata of the Zarr folder
        // Changes when a chunk of the Zarr folder changes; empty without a Zarr folder. A change while a field is read
        // does not make read() fail, because a simulation may be writing other arrays of the folder.
        std::string chunks;
    };
    // A field in memory, under the name with which it was read.
    struct CachedField {
        std::string key;
        session::ObjectWithWarnings loaded;
        // The copies of the field under other names. They keep the field in use (see fields::changedCopy()).
        std::map<std::string, std::weak_ptr<const fields::Field>, std::less<>> renamed = {};
        std::size_t bytes = 0;
        bool onDisk = false;  // whether the field has a file in the field cache
    };

    std::vector<std::string> readNames() const;
    std::vector<std::string> namesInStore() const;
    Result<OpenedEntry> openInStore(const std::string& name) const;
    Result<OpenedEntry> open(const std::string& name) const;
    static std::string currentVersion(const OpenedEntry& opened);
    Result<session::ObjectWithWarnings> readAndKeep(const session::LoadObject& load, const session::Limits& limits,
                                                    OpenedEntry opened, const Reader& reader, const std::string& key);
    Result<FieldCacheFiles::FilePtr> makeCacheFile(std::size_t bytes);
    bool dropOneUnused(bool onDisk);
    Result<session::ObjectWithWarnings> keep(std::string key, session::ObjectWithWarnings loaded, bool onDisk);
    std::optional<session::ObjectWithWarnings> find(const std::string& key, const std::string& name);

    const std::filesystem::path folder_;              // empty if there is none on a disk
    const std::unique_ptr<const ObjectStore> store_;  // null if there is none
    const std::size_t maxBytes_;
    FieldCacheFiles& fieldCacheFiles_;
    mutable std::mutex namesMutex_;  // guards names_ and listed_
    mutable std::vector<std::string> names_;
    mutable Clock::time_point listed_ = Clock::time_point::min();
    // Guards the members below. A thread may hold this mutex while it allocates or frees gigabytes on the disk.
    // Therefore knownNames() and bytesInMemory(), which threads that serve sockets call, do not lock the mutex.
    std::mutex mutex_;
    std::list<CachedField> recent_;      // the most recently used first
    std::atomic<std::size_t> bytes_{0};  // total memory of the fields in `recent_`, in bytes
    std::set<std::string> reading_;      // the keys of the fields that threads are reading now
    std::condition_variable readEnded_;  // notified when a key is removed from `reading_`
};

}  // namespace oval4d::net
