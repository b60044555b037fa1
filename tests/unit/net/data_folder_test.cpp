// How often the arrays of the data folder are read, and when sessions share an array.

#include "net/data_folder.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "fields/array_field.hpp"
#include "slicing/object.hpp"
#include "unit/store/temporary_folder.hpp"

namespace oval4d::net {
namespace {

// Returns a field of 16 samples.
slicing::Object smallField(const std::string& name) {
    fields::FieldArray array;
    array.shape = {2, 2, 2, 2};
    array.box = {glm::dvec4(0), glm::dvec4(1)};
    std::vector<float> values(16);
    values[3] = 1;
    array.samples = fields::SampleStorage(std::move(values));
    return std::make_shared<const fields::Field>(*fields::fieldFromArray(name, array));
}

class DataFolderTest : public testing::Test {
  protected:
    DataFolderTest() {
        std::filesystem::create_directory(temporary.path / "run");
        std::ofstream(temporary.path / "run" / "zarr.json") << "{}";
    }

    slicing::FieldPtr read(const std::string& name, const std::optional<fields::Box>& region = {}) {
        session::LoadObject load{name, "", {}};
        load.dataName = "run";
        load.region = region;
        const DataFolder::Reader reader =
            [this](const session::LoadObject& file, const session::Limits& /*limits*/,
                   const file_reading::FileAllocator& /*allocate*/) -> Result<session::ObjectWithWarnings> {
            ++reads;
            return session::ObjectWithWarnings{smallField(file.name), {}};
        };
        const auto loaded = folder().read(load, {}, reader);
        EXPECT_TRUE(loaded) << loaded.error().message;
        return loaded ? std::get<slicing::FieldPtr>(loaded->object) : nullptr;
    }
    DataFolder& folder() {
        if (!folder_) folder_ = std::make_unique<DataFolder>(temporary.path.string(), maxBytes, cacheFiles);
        return *folder_;
    }

    store::Folder temporary;
    FieldCacheFiles cacheFiles{"", 0};
    std::size_t maxBytes = std::size_t{1} << 20U;
    int reads = 0;

  private:
    std::unique_ptr<DataFolder> folder_;
};

TEST_F(DataFolderTest, ReadsAPartOnceUnderAllNames) {
    const fields::Box region{glm::dvec4(0), glm::dvec4(0.5)};
    const auto first = read("run", region), again = read("run", region), other = read("other", region);
    EXPECT_EQ(reads, 1);
    EXPECT_EQ(again, first);
    EXPECT_EQ(first->name, "run");
    EXPECT_EQ(other->name, "other");
    EXPECT_NE(other->serial, first->serial);
    EXPECT_EQ(other->array, first->array);
    EXPECT_TRUE(other->shared);
    EXPECT_EQ(read("other", region), other);
    EXPECT_EQ(folder().bytesInMemory(), slicing::memoryOf(slicing::Object(first)));
    read("run");
    EXPECT_EQ(reads, 2) << "another part";
}

TEST_F(DataFolderTest, KeepsAFieldThatIsUsedUnderAnotherName) {
    maxBytes = slicing::memoryOf(smallField("run")) + 1000;
    const fields::Box region{glm::dvec4(0), glm::dvec4(0.5)};
    read("run", region);
    auto used = read("other", region);
    session::LoadObject load{"run", "", {}};
    load.dataName = "run";
    const DataFolder::Reader reader =
        [](const session::LoadObject& file, const session::Limits& /*limits*/,
           const file_reading::FileAllocator& /*allocate*/) -> Result<session::ObjectWithWarnings> {
        return session::ObjectWithWarnings{smallField(file.name), {}};
    };
    const auto refused = folder().read(load, {}, reader);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::too_many);
    used.reset();
    EXPECT_TRUE(folder().read(load, {}, reader));
}

TEST_F(DataFolderTest, ThreadsThatOpenTheSamePartWaitForOneReader) {
    session::LoadObject load{"run", "", {}};
    load.dataName = "run";
    std::promise<void> begun, finish;
    const DataFolder::Reader slow =
        [&](const session::LoadObject& file, const session::Limits& /*limits*/,
            const file_reading::FileAllocator& /*allocate*/) -> Result<session::ObjectWithWarnings> {
        begun.set_value();  // throws an exception if the reader is called twice
        finish.get_future().wait();
        return session::ObjectWithWarnings{smallField(file.name), {}};
    };
    DataFolder& shared = folder();
    const auto open = [&] { return shared.read(load, {}, slow); };
    auto first = std::async(std::launch::async, open);
    begun.get_future().wait();
    auto second = std::async(std::launch::async, open);
    finish.set_value();
    const auto one = first.get(), two = second.get();
    ASSERT_TRUE(one && two);
    EXPECT_EQ(one->object, two->object);
}

}  // namespace
}  // namespace oval4d::net
