#pragma once
// The folder of arrays that the server offers to all sessions (option --data).

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

/// A folder of arrays, on a disk or in an object store. Each entry is a file, a Zarr folder, or a series. A series is a
/// folder whose files are the time steps of one array. Clients refer to entries by name. Names that begin with a dot or
/// lead outside the folder are refused, and symbolic links are not followed. Thread-safe.
///
/// Sessions that open the same file in the same way share one copy, whatever names they give to it, until the file
/// changes. Fields larger than session::Limits::maxFieldBytes are mapped into memory: from the file in the folder or,
/// if the samples must be converted, from a file of the field cache (see FieldCacheFiles).
///
/// The entries in an object store are Zarr folders. A field from a store is read again when the metadata of its Zarr
/// folder have changed; changes of chunks are not noticed.
class DataFolder {
  public:
    /// `folder` is a path or the address of an object store; empty if the server offers no arrays. `bytes` is the
    /// maximum memory of all fields from the folder, used or not. `fieldCacheFiles` must outlive the fields. Throws
    /// std::runtime_error if the folder cannot be read, and std::invalid_argument if the address is not valid.
    DataFolder(const std::string& folder, std::size_t bytes, FieldCacheFiles& fieldCacheFiles,
               const ObjectStoreLimits& storeLimits = {});

    /// A function that reads a file. It has the same effect as FileReaderPool::read().
    using Reader = std::function<Result<session::ObjectWithWarnings>(
        const session::LoadObject& load, const session::Limits& limits, const file_reading::FileAllocator& allocate)>;

    /// Returns the names of the entries that can be opened, in alphabetical order; at most kMaxNames. Blocks the
    /// calling thread while it reads the folder, unless cachedNames() has the names. An object store lists its names in
    /// its object index.json, a JSON array of strings; without this object, there are no names.
    std::vector<std::string> entryNames() const;
    /// Returns the names that entryNames() read last, if it began to read the folder less than kListedFor ago;
    /// otherwise an empty optional. Without a data folder, returns an empty list.
    std::optional<std::vector<std::string>> cachedNames() const;

    /// Returns the field of the entry `load.dataName`. If the field is not in memory, calls `reader` with a copy of
    /// `load` that contains the opened files. Blocks the calling thread until this or another thread has read the
    /// field. Errors:
    /// - `not_found` if the folder has no such entry;
    /// - `too_large` if the field takes more memory or disk space than allowed, or if a series has more than kMaxSeries
    ///   files;
    /// - `too_many` if fields in use leave too little memory or disk space;
    /// - `bad_field` if the file is not an array, or has changed while it was read;
    /// - those of `reader` and of ObjectStore::get().
    Result<session::ObjectWithWarnings> read(const session::LoadObject& load, const session::Limits& limits,
                                             const Reader& reader);

    /// Returns the memory that all fields from the folder take, in bytes.
    std::size_t bytesInMemory() const;

    /// The maximum number of names that entryNames() returns, and the maximum number of files in a series.
    static constexpr std::size_t kMaxNames = 1000, kMaxSeries = 1000;
    /// The time for which cachedNames() returns the names that were read last.
    static constexpr std::chrono::seconds kListedFor{2};

  private:
    using Clock = std::chrono::steady_clock;
    // An entry that open() has opened: a file, a Zarr folder or a series.
    struct OpenedEntry {
        std::vector<std::shared_ptr<const fields::FileHandle>> files;  // the file, or the files of the series
        std::shared_ptr<const fields::FolderFileProvider> folder;      // the Zarr folder, instead of `files`; else null
        bool series = false;
        std::string version;  // changes with `files` or the metadata of the Zarr folder
        // Changes when a chunk of the Zarr folder changes; empty without a Zarr folder. Such a change during read() is
        // no error, because a simulation may be writing other arrays of the folder.
        std::string chunks;
    };
    // A field in memory, under the name with which it was first read.
    struct CachedField {
        std::string key;
        session::ObjectWithWarnings loaded;
        // Copies of the field under other names. A copy in use also keeps the field in use (see fields::changedCopy()).
        std::map<std::string, std::weak_ptr<const fields::Field>, std::less<>> renamed = {};
        std::size_t bytes = 0;
        bool onDisk = false;  // whether the field has a file in the field cache
    };

    std::vector<std::string> readNames() const;
    std::vector<std::string> namesInObjectStore() const;
    Result<OpenedEntry> openInObjectStore(const std::string& name) const;
    Result<OpenedEntry> open(const std::string& name) const;
    static std::string currentVersion(const OpenedEntry& opened);
    Result<session::ObjectWithWarnings> readAndCache(const session::LoadObject& load, const session::Limits& limits,
                                                     OpenedEntry opened, const Reader& reader, const std::string& key);
    Result<FieldCacheFiles::FilePtr> makeCacheFile(std::size_t bytes);
    bool evictUnusedField(bool onDisk);
    Result<session::ObjectWithWarnings> putInCache(std::string key, session::ObjectWithWarnings loaded, bool onDisk);
    std::optional<session::ObjectWithWarnings> findCachedField(const std::string& key, const std::string& name);

    const std::filesystem::path folder_;              // empty if there is none on a disk
    const std::unique_ptr<const ObjectStore> store_;  // null without an object store
    const std::size_t maxBytes_;
    FieldCacheFiles& fieldCacheFiles_;
    mutable std::mutex namesMutex_;  // guards names_ and listed_
    mutable std::vector<std::string> names_;
    mutable Clock::time_point listed_ = Clock::time_point::min();
    // Guards the members below. A thread may hold this mutex while it allocates or frees gigabytes on the disk. The
    // threads that serve sockets must not wait for that. They call only cachedNames() and bytesInMemory(), which do not
    // lock the mutex.
    std::mutex mutex_;
    std::list<CachedField> recent_;      // the most recently used first
    std::atomic<std::size_t> bytes_{0};  // total memory of the fields in `recent_`, in bytes
    std::set<std::string> reading_;      // the keys of the fields that threads are reading now
    std::condition_variable readEnded_;  // notified when a key is removed from `reading_`
};

}  // namespace oval4d::net
