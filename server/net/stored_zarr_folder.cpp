#include "net/stored_zarr_folder.hpp"

#include <functional>
#include <utility>

namespace oval4d::net {

Result<std::shared_ptr<const ObjectStoreZarrFolder>> ObjectStoreZarrFolder::open(const ObjectStore& store,
                                                                                 const std::string& name) {
    const std::shared_ptr<ObjectStoreZarrFolder> folder(new ObjectStoreZarrFolder(store, name));
    const auto read = [&](const std::string& file) -> Result<bool> {
        auto text = store.get(folder->prefix_ + file, {});
        if (!text) return text.error();
        return folder->metadata_.insert_or_assign(file, std::move(*text)).first->second.has_value();
    };
    const auto isVersion3 = read("zarr.json");
    if (!isVersion3) return isVersion3.error();
    if (*isVersion3) return std::shared_ptr<const ObjectStoreZarrFolder>(folder);
    bool isVersion2 = false;
    for (const char* const file : {".zarray", ".zgroup"}) {
        const auto found = read(file);
        if (!found) return found.error();
        isVersion2 = isVersion2 || *found;
    }
    if (!isVersion2) return std::shared_ptr<const ObjectStoreZarrFolder>();
    for (const char* const file : {".zattrs", ".zmetadata"}) {
        if (const auto found = read(file); !found) return found.error();
    }
    return std::shared_ptr<const ObjectStoreZarrFolder>(folder);
}

Result<std::optional<fields::FoundFile>> ObjectStoreZarrFolder::findFile(const std::string& path,
                                                                         const fields::FilePart& part,
                                                                         std::chrono::steady_clock::time_point until,
                                                                         const std::stop_token& stop) const {
    const auto known = part.isWhole() ? metadata_.find(path) : metadata_.end();
    auto bytes = known == metadata_.end() ? store_.get(prefix_ + path, part, until, stop)
                                          : Result<std::optional<std::string>>(known->second);
    if (!bytes) return bytes.error();
    if (!*bytes) return std::optional<fields::FoundFile>();
    return std::optional(fields::FoundFile{nullptr, std::move(**bytes)});
}

std::string ObjectStoreZarrFolder::version() const {
    std::string version;
    for (const auto& [path, text] : metadata_) {
        if (text)
            version +=
                path + ':' + std::to_string(text->size()) + ':' + std::to_string(std::hash<std::string>()(*text)) + ';';
    }
    return version;
}

}  // namespace oval4d::net
