#pragma once
// A Zarr folder in an object store.

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "errors/error.hpp"
#include "fields/readers/folder_files.hpp"
#include "net/object_store.hpp"

namespace oval4d::net {

/// A Zarr folder in an object store. open() reads the metadata files of the folder once, so that all of a field is read
/// with the same metadata.
class ObjectStoreZarrFolder final : public fields::FolderFileProvider {
  public:
    /// Opens the folder called `name`, and reads its metadata. Returns null if there is no such Zarr folder. Errors:
    /// those of ObjectStore::get(). `store` must outlive the folder.
    static Result<std::shared_ptr<const ObjectStoreZarrFolder>> open(const ObjectStore& store, const std::string& name);

    Result<std::optional<fields::FoundFile>> findFile(const std::string& path, const fields::FilePart& part,
                                                      std::chrono::steady_clock::time_point until,
                                                      const std::stop_token& stop) const override;
    /// Returns a text that identifies the version of the folder. It depends only on the metadata that open() has read.
    std::string version() const override;

  private:
    ObjectStoreZarrFolder(const ObjectStore& store, const std::string& name) : store_(store), prefix_(name + '/') {}

    const ObjectStore& store_;
    const std::string prefix_;
    // The texts of the metadata files that open() has read, by path. An empty optional means that the file is missing.
    std::map<std::string, std::optional<std::string>> metadata_;
};

}  // namespace oval4d::net
