#include "net/data_folder.hpp"

#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <functional>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>

#include "fields/array/array_function.hpp"
#include "fields/field.hpp"
#include "fields/readers/field_reader.hpp"
#include "fields/readers/zarr.hpp"
#include "file_reading/folder_access.hpp"
#include "net/stored_zarr_folder.hpp"
#include "text/message_text.hpp"

namespace oval4d::net {

namespace fs = std::filesystem;

namespace {

/// Opens the file or folder `name` for reading; fails if it is a symbolic link. `folder` is the descriptor of the
/// folder that contains `name`, or AT_FDCWD if `name` is a path. `flags` are further flags for openat(). Returns the
/// new descriptor, or −1 on failure.
int openWithoutFollowing(int folder, const std::string& name, int flags) {
    return openat(folder, name.c_str(), flags | O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
}

/// Returns a text that identifies the version of the file with the status `status`. The text changes when the file
/// changes.
std::string fileVersionOf(const struct stat& status) {
    return std::to_string(status.st_ino) + ':' + std::to_string(status.st_size) + ':' +
           std::to_string(status.st_mtim.tv_sec) + '.' + std::to_string(status.st_mtim.tv_nsec) + ';';
}

/// Returns a text that identifies the version of an open file; an empty string if `file` is not a regular file.
std::string fileVersionOf(int file) {
    struct stat status{};
    if (fstat(file, &status) != 0 || !S_ISREG(status.st_mode)) return {};
    return fileVersionOf(status);
}

/// Returns a text that identifies the version of a Zarr folder; an empty string if `folder` is not a Zarr folder. The
/// text changes when the metadata of the folder change, or when files directly in the folder are added or removed.
std::string versionOfZarr(int folder) {
    std::string version;
    for (const std::string_view name : fields::kZarrFiles) {
        const fields::FileHandle file(openWithoutFollowing(folder, std::string(name), 0));
        version += fileVersionOf(file.descriptor());
    }
    if (version.empty()) return version;
    for (const char* const name : {".zattrs", ".zmetadata"}) {
        const fields::FileHandle file(openWithoutFollowing(folder, name, 0));
        version += fileVersionOf(file.descriptor());
    }
    struct stat status{};
    if (fstat(folder, &status) == 0)
        version += std::to_string(status.st_mtim.tv_sec) + '.' + std::to_string(status.st_mtim.tv_nsec);
    return version;
}

/// Returns a text that changes when any file below the folder changes, such as a chunk of a Zarr array. Does not follow
/// symbolic links. Considers at most kMaxFiles files, because reading the status of each file takes time.
std::string versionOfFilesIn(const fs::path& folder) {
    constexpr std::size_t kMaxFiles = 10'000;
    std::size_t count = 0, sum = 0;  // `sum`, of hashes, does not depend on the order in which the files are found
    std::error_code fault;
    for (fs::recursive_directory_iterator entry(folder, fault), end; !fault && entry != end && count < kMaxFiles;
         entry.increment(fault)) {
        struct stat status{};
        if (lstat(entry->path().c_str(), &status) != 0 || !S_ISREG(status.st_mode)) continue;
        ++count;
        sum += std::hash<std::string>()(entry->path().string() + ':' + fileVersionOf(status));
    }
    return std::to_string(count) + ':' + std::to_string(sum) + ';';
}

/// A Zarr folder on a disk.
class ZarrFolderOnDisk final : public fields::FolderFileProvider {
  public:
    explicit ZarrFolderOnDisk(std::shared_ptr<const fields::FileHandle> folder) : folder_(std::move(folder)) {}

    Result<std::optional<fields::FoundFile>> findFile(const std::string& path, const fields::FilePart& /*part*/,
                                                      std::chrono::steady_clock::time_point /*until*/,
                                                      const std::stop_token& /*stop*/) const override {
        const int file = file_reading::openFileWithin(folder_->descriptor(), path);
        if (file < 0) return std::optional<fields::FoundFile>();
        return std::optional(fields::FoundFile{std::make_shared<const fields::FileHandle>(file), {}});
    }
    std::string version() const override { return versionOfZarr(folder_->descriptor()); }

  private:
    const std::shared_ptr<const fields::FileHandle> folder_;
};

bool isZarrFolder(const fs::path& folder) {
    const fields::FileHandle handle(openWithoutFollowing(AT_FDCWD, folder.string(), O_DIRECTORY));
    return handle.descriptor() >= 0 && !versionOfZarr(handle.descriptor()).empty();
}

bool isArrayFile(int file) {
    std::array<std::byte, fields::kRecognizedBytes> start{};
    const ssize_t size = pread(file, start.data(), start.size(), 0);
    return size > 0 && fields::formatOfFile(std::span(start).first(static_cast<std::size_t>(size))) != nullptr;
}

/// Returns whether clients may use this name for an entry: one path component in UTF-8 that does not begin with a dot.
bool isAllowedName(const std::string& name) {
    return !name.empty() && name.front() != '.' && name.find('/') == std::string::npos &&
           name.find('\0') == std::string::npos && text::isUtf8(name);
}

/// Returns a cache key for the result of reading `load`. The key contains everything that determines the result, except
/// the name of the field. `version` identifies the version of the file or folder.
std::string cacheKeyOf(const session::LoadObject& load, const std::string& version) {
    std::string key = load.dataName + '\0' + load.format + '\0' + load.axes + '\0' + load.variable + '\0';
    key += load.secondFormula + '\0' + load.secondVariable + '\0';
    for (const auto& box : {load.box, load.region}) {
        key += box ? '1' : '0';
        if (box) key.append(reinterpret_cast<const char*>(&*box), sizeof *box);
    }
    key += load.finer ? '1' : '0';
    if (load.finer) {
        key.append(reinterpret_cast<const char*>(&load.finer->level), sizeof load.finer->level);
        key.append(reinterpret_cast<const char*>(&load.finer->initialLevel), sizeof load.finer->initialLevel);
    }
    return key + '\0' + version;
}

/// Returns a copy of the loaded field in which Field::shared is true. The memory of such a field does not count against
/// the sessions that use it, because DataFolder::bytes_ counts it. Sets Field::source if the samples are in a mapped
/// file, are a part of an array, or have replaced a coarser level of an image. Returns the error `bad_field` if the
/// object is not an array.
Result<session::ObjectWithWarnings> copyMarkedShared(session::ObjectWithWarnings loaded,
                                                     const session::LoadObject& load) {
    const fields::Field* const field = slicing::fieldIn(loaded.object);
    if (field == nullptr || !field->array) return Error{ErrorCode::bad_field, "the file is not an array"};
    auto copy = std::make_shared<fields::Field>(*field);
    copy->shared = true;
    const bool isMapped = field->array->storage().file() ||
                          (field->second && field->second->array && field->second->array->storage().file());
    if (load.finer) copy->initialLevel = load.finer->initialLevel;
    if (isMapped || field->isPart || load.finer) {
        copy->source = std::make_shared<const fields::FieldFileSource>(
            fields::FieldFileSource{load.dataName, load.format, load.axes, load.variable, load.secondFormula,
                                    load.secondVariable, load.box, load.region});
    }
    loaded.object = slicing::FieldPtr(std::move(copy));
    return loaded;
}

}  // namespace

DataFolder::DataFolder(const std::string& folder, std::size_t bytes, FieldCacheFiles& fieldCacheFiles,
                       const ObjectStoreLimits& storeLimits)
    : folder_(folder.empty() || ObjectStore::isUrl(folder) ? fs::path() : fs::canonical(folder)),
      store_(ObjectStore::isUrl(folder) ? std::make_unique<const ObjectStore>(folder, storeLimits) : nullptr),
      maxBytes_(bytes),
      fieldCacheFiles_(fieldCacheFiles) {
    std::error_code fault;
    if (!folder_.empty() && fs::directory_iterator(folder_, fault) == fs::directory_iterator())
        if (fault) throw std::runtime_error("the data folder cannot be read: " + fault.message());
}

std::vector<std::string> DataFolder::entryNames() const {
    if (auto known = cachedNames()) return *std::move(known);
    const Clock::time_point began = Clock::now();
    std::vector<std::string> found = readNames();
    const std::lock_guard lock(namesMutex_);
    names_ = found;
    listed_ = began;
    return found;
}

std::optional<std::vector<std::string>> DataFolder::cachedNames() const {
    if (folder_.empty() && !store_) return std::vector<std::string>();
    const std::lock_guard lock(namesMutex_);
    if (listed_ == Clock::time_point::min() || Clock::now() - listed_ >= kListedFor) return {};
    return names_;
}

std::vector<std::string> DataFolder::namesInObjectStore() const {
    std::vector<std::string> found;
    const auto text = store_->get("index.json", {});  // get() logs its errors
    if (!text || !*text) return found;
    const auto list = nlohmann::json::parse(**text, nullptr, false);
    if (!list.is_array()) {
        spdlog::warn("the object store lists no arrays: index.json is not a JSON array of strings");
        return found;
    }
    for (const auto& each : list) {
        if (!each.is_string()) continue;
        auto name = each.get<std::string>();
        if (isAllowedName(name)) found.push_back(std::move(name));
    }
    return found;
}

std::vector<std::string> DataFolder::readNames() const {
    std::vector<std::string> found = store_ ? namesInObjectStore() : std::vector<std::string>();
    std::error_code fault;
    for (fs::directory_iterator entry(folder_, fault), end; !fault && entry != end; entry.increment(fault)) {
        const std::string name = entry->path().filename().string();
        std::error_code unknown;
        const auto type = entry->symlink_status(unknown).type();
        if (!isAllowedName(name) || (type != fs::file_type::regular && type != fs::file_type::directory)) continue;
        if (type == fs::file_type::directory) {
            const auto files = fields::seriesFiles(entry->path());
            if (!isZarrFolder(entry->path()) && (!files || files->empty())) continue;
        } else {
            const fields::FileHandle file(openWithoutFollowing(AT_FDCWD, entry->path().string(), 0));
            if (file.descriptor() < 0 || !isArrayFile(file.descriptor())) continue;
        }
        found.push_back(name);
    }
    std::ranges::sort(found);
    found.resize(std::min(found.size(), kMaxNames));
    return found;
}

/// Opens the entry with this name. An entry is a file, a Zarr folder, or a folder with the files of a series.
Result<DataFolder::OpenedEntry> DataFolder::open(const std::string& name) const {
    const Error missing{ErrorCode::not_found, "the data folder has no " + text::inQuotes(name)};
    if (folder_.empty() && !store_) return Error{ErrorCode::not_found, "this server has no data folder (--data)"};
    if (!isAllowedName(name)) return missing;
    if (store_) return openInObjectStore(name);
    const fields::FileHandle root(::open(folder_.c_str(), O_RDONLY | O_CLOEXEC | O_DIRECTORY));
    auto file = std::make_shared<const fields::FileHandle>(openWithoutFollowing(root.descriptor(), name, 0));
    if (file->descriptor() < 0) return missing;
    OpenedEntry opened;
    opened.version = fileVersionOf(file->descriptor());
    if (!opened.version.empty()) {
        opened.files.push_back(std::move(file));
        return opened;
    }
    auto folder =
        std::make_shared<const fields::FileHandle>(openWithoutFollowing(root.descriptor(), name, O_DIRECTORY));
    if (folder->descriptor() < 0) return missing;
    if (opened.version = versionOfZarr(folder->descriptor()); !opened.version.empty()) {
        opened.folder = std::make_shared<const ZarrFolderOnDisk>(std::move(folder));
        opened.chunks = versionOfFilesIn(folder_ / name);
        return opened;
    }
    const fields::FileHandle& series = *folder;
    const auto paths = fields::seriesFiles(folder_ / name);
    if (!paths || paths->empty()) return missing;
    if (paths->size() > kMaxSeries)
        return Error{ErrorCode::too_large, "a series may have at most " + std::to_string(kMaxSeries) + " files"};
    opened.series = true;
    for (const fs::path& path : *paths) {
        file = std::make_shared<const fields::FileHandle>(
            openWithoutFollowing(series.descriptor(), path.filename().string(), 0));
        const std::string version = fileVersionOf(file->descriptor());
        if (version.empty()) return missing;
        opened.version += version;
        opened.files.push_back(std::move(file));
    }
    return opened;
}

Result<DataFolder::OpenedEntry> DataFolder::openInObjectStore(const std::string& name) const {
    auto folder = ObjectStoreZarrFolder::open(*store_, name);
    if (!folder) return folder.error();
    if (!*folder)
        return Error{ErrorCode::not_found,
                     "the object store of --data has no Zarr array or group " + text::inQuotes(name)};
    OpenedEntry opened;
    opened.version = (*folder)->version();
    opened.folder = std::move(*folder);
    return opened;
}

std::string DataFolder::currentVersion(const OpenedEntry& opened) {
    if (opened.folder) return opened.folder->version();
    std::string version;
    for (const auto& file : opened.files) version += net::fileVersionOf(file->descriptor());
    return version;
}

/// Returns the cached field with the key `key`, or a copy of it with the name `name` if its name differs. Marks the
/// field as the most recently used. Returns an empty optional if the cache lacks the field or if the field's file can
/// no longer be read. The caller must hold mutex_.
std::optional<session::ObjectWithWarnings> DataFolder::findCachedField(const std::string& key,
                                                                       const std::string& name) {
    const auto found = std::ranges::find(recent_, key, &CachedField::key);
    if (found == recent_.end()) return {};
    const slicing::FieldPtr field = std::get<slicing::FieldPtr>(found->loaded.object);
    if (field->hasLostSamples()) {
        bytes_ -= found->bytes;
        recent_.erase(found);
        return {};
    }
    recent_.splice(recent_.begin(), recent_, found);
    session::ObjectWithWarnings loaded = found->loaded;
    if (field->name == name) return loaded;
    std::erase_if(found->renamed, [](const auto& copy) { return copy.second.expired(); });
    slicing::FieldPtr copy = found->renamed[name].lock();
    if (!copy) {
        copy = fields::changedCopy(field, [&](fields::Field& other) { other.name = name; });
        found->renamed[name] = copy;
    }
    loaded.object = std::move(copy);
    return loaded;
}

/// Drops the least recently used field among those that no session uses. If `onDisk` is true, considers only fields
/// with a file in the field cache. Returns false if there is no such field. The caller must hold mutex_.
bool DataFolder::evictUnusedField(bool onDisk) {
    const auto isUnused = [&](const CachedField& field) {
        return std::get<slicing::FieldPtr>(field.loaded.object).use_count() == 1 && (field.onDisk || !onDisk);
    };
    const auto last = std::find_if(recent_.rbegin(), recent_.rend(), isUnused);
    if (last == recent_.rend()) return false;
    bytes_ -= last->bytes;
    recent_.erase(std::next(last).base());
    return true;
}

/// Makes a file of `bytes` bytes in the field cache. If there is no room, first drops fields that no session uses and
/// that have a file there.
/// Errors: those of FieldCacheFiles::allocateFile(); `too_many` if the fields in use leave no room.
Result<FieldCacheFiles::FilePtr> DataFolder::makeCacheFile(std::size_t bytes) {
    const std::lock_guard lock(mutex_);
    for (;;) {
        auto file = fieldCacheFiles_.allocateFile(bytes);
        if (!file || *file) return file;
        if (!evictUnusedField(true)) {
            return Error{
                ErrorCode::too_many,
                "the fields that sessions use leave no room on the disk for this one (--field-cache); try again "
                "later"};
        }
    }
}

/// Puts a field into the cache in memory (recent_) under `key`. Makes room by dropping the least recently used fields
/// that no session uses. `onDisk` tells whether the field also has a file in the field cache on disk (see
/// FieldCacheFiles). Errors: `too_large` if the field alone exceeds the maximum memory; `too_many` if the fields in use
/// leave no room.
Result<session::ObjectWithWarnings> DataFolder::putInCache(std::string key, session::ObjectWithWarnings loaded,
                                                           bool onDisk) {
    const std::size_t size = slicing::memoryOf(loaded.object);
    const std::lock_guard lock(mutex_);
    if (size > maxBytes_)
        return Error{ErrorCode::too_large, "this field takes more memory than the fields of the data folder may (" +
                                               std::to_string(maxBytes_) + " bytes, --data-cache)"};
    while (bytes_ + size > maxBytes_ && evictUnusedField(false)) continue;
    if (bytes_ + size > maxBytes_)
        return Error{ErrorCode::too_many,
                     "the fields of the data folder that sessions use leave no room for this one "
                     "(--data-cache); try again later"};
    bytes_ += size;
    recent_.push_front({.key = std::move(key), .loaded = loaded, .bytes = size, .onDisk = onDisk});
    return loaded;
}

Result<session::ObjectWithWarnings> DataFolder::read(const session::LoadObject& load, const session::Limits& limits,
                                                     const Reader& reader) {
    auto opened = open(load.dataName);
    if (!opened) return opened.error();
    const std::string key = cacheKeyOf(load, opened->version + opened->chunks);
    {
        std::unique_lock lock(mutex_);
        readEnded_.wait(lock, [&] { return !reading_.contains(key); });
        if (auto known = findCachedField(key, load.name)) return *std::move(known);
        reading_.insert(key);
    }
    struct ReadGuard {
        DataFolder& folder;
        const std::string& key;
        ~ReadGuard() {
            const std::lock_guard lock(folder.mutex_);
            folder.reading_.erase(key);
            folder.readEnded_.notify_all();
        }
    } const readGuard{*this, key};
    return readAndCache(load, limits, std::move(*opened), reader, key);
}

Result<session::ObjectWithWarnings> DataFolder::readAndCache(const session::LoadObject& load,
                                                             const session::Limits& limits, OpenedEntry opened,
                                                             const Reader& reader, const std::string& key) {
    session::LoadObject file = load;
    if (opened.folder) {
        file.folder = opened.folder;
    } else if (opened.series) {
        file.series = opened.files;
    } else {
        file.file = opened.files.front();
    }
    bool onDisk = false;
    const Error changed{ErrorCode::bad_field, "the file changed while it was being read; load it again"};
    Result<session::ObjectWithWarnings> loaded = changed;
    try {
        loaded = reader(file, limits, [&](std::size_t bytes) {
            onDisk = true;
            return makeCacheFile(bytes);
        });
    } catch (const std::runtime_error&) {
        if (currentVersion(opened) == opened.version) throw;
        return changed;
    }
    if (!loaded) return loaded.error();
    if (onDisk && currentVersion(opened) != opened.version) return changed;
    auto marked = copyMarkedShared(std::move(*loaded), load);
    if (!marked) return marked.error();
    return putInCache(key, std::move(*marked), onDisk);
}

std::size_t DataFolder::bytesInMemory() const { return bytes_; }

}  // namespace oval4d::net
