// Tests of mapped files, including files that become shorter while they are mapped.

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <thread>
#include <vector>

#include "fields/array/mapped_file.hpp"
#include "fields/array/sample_storage.hpp"

namespace oval4d::fields::test {
namespace {

constexpr std::size_t kSize = 1 << 20;

/// Returns an unnamed file of `size` bytes, all of which are 1.
std::shared_ptr<const FileHandle> fileOf(std::size_t size) {
    auto file = std::make_shared<const FileHandle>(memfd_create("test", MFD_CLOEXEC));
    const std::vector<char> ones(size, 1);
    EXPECT_EQ(write(file->descriptor(), ones.data(), size), static_cast<ssize_t>(size));
    return file;
}

bool areAll(std::span<const std::byte> bytes, int value) {
    return std::ranges::all_of(bytes, [&](std::byte each) { return each == std::byte(value); });
}

TEST(MappedFile, AFileThatIsShortenedIsLostAndAnotherOneIsNot) {
    const auto file = fileOf(kSize), other = fileOf(kSize);
    const auto mapped = *MappedFile::map(file), intact = *MappedFile::map(other);
    EXPECT_TRUE(areAll(mapped->bytes(), 1));
    EXPECT_FALSE(mapped->isLost());
    ASSERT_EQ(ftruncate(file->descriptor(), 4096), 0);
    EXPECT_TRUE(mapped->isLost()) << "which its size shows";
    EXPECT_TRUE(areAll(mapped->bytes().last(kSize / 2), 0));
    EXPECT_TRUE(areAll(mapped->bytes(), 0)) << "the whole of it";
    mapped->releasePages();
    EXPECT_TRUE(areAll(mapped->bytes(), 0));
    EXPECT_TRUE(areAll(intact->bytes(), 1));
    EXPECT_FALSE(intact->isLost());
}

TEST(MappedFile, IsLostWithoutItsDescriptorAsSoonAsItIsRead) {
    const auto file = fileOf(kSize);
    const auto mapped = *MappedFile::map(file->descriptor());
    ASSERT_EQ(ftruncate(file->descriptor(), 0), 0);
    EXPECT_FALSE(mapped->isLost());
    EXPECT_TRUE(areAll(mapped->bytes(), 0));
    EXPECT_TRUE(mapped->isLost());
}

TEST(MappedFile, ThreadsMayReadWhileItIsShortened) {
    for (int round = 0; round < 20; ++round) {
        const auto file = fileOf(kSize);
        const auto mapped = *MappedFile::map(file);
        std::atomic<bool> end = false;
        std::vector<std::jthread> threads;
        for (int i = 0; i < 4; ++i) {
            threads.emplace_back([&] {
                while (!end) {
                    EXPECT_TRUE(std::ranges::all_of(mapped->bytes(), [](std::byte b) { return b <= std::byte{1}; }));
                    mapped->releasePages();
                }
            });
        }
        ASSERT_EQ(ftruncate(file->descriptor(), 100), 0);
        EXPECT_EQ(mapped->bytes().back(), std::byte{0});
        end = true;
    }
}

TEST(MappedFileDeathTest, OtherBusErrorsEndTheProcess) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(
        {
            const auto file = fileOf(kSize);
            const auto mapped = MappedFile::map(file);
            const auto* at =
                static_cast<const volatile char*>(mmap(nullptr, kSize, PROT_READ, MAP_SHARED, file->descriptor(), 0));
            if (ftruncate(file->descriptor(), 0) == 0) std::exit(at[kSize - 1]);
        },
        [](int status) { return status != 0; }, "");
}

TEST(MappedFile, WritesAndReadsTheSameFile) {
    const auto file = fileOf(kSize);
    const auto writable = *MappedFile::mapForWriting(file);
    const auto readable = *MappedFile::map(file);
    writable->writableBytes().back() = std::byte{7};
    writable->releasePages();
    EXPECT_EQ(readable->bytes().back(), std::byte{7});
    EXPECT_THROW(SampleStorage(readable, 2, 1), std::invalid_argument);
    EXPECT_THROW(SampleStorage(readable, kSize, 1), std::invalid_argument);
    EXPECT_THROW(SampleStorage(readable, 0, kSize), std::invalid_argument);
    const SampleStorage samples(readable, kSize - 4, 1);
    EXPECT_EQ(samples.memoryBytes(), 0U);
    EXPECT_EQ(samples.byteOffsetInFile(), kSize - 4);
}

TEST(MappedFile, RefusesWhatIsNotAFile) {
    EXPECT_EQ(MappedFile::map(-1).error().code, ErrorCode::bad_field);
    EXPECT_EQ(MappedFile::map(fileOf(0)).error().code, ErrorCode::bad_field);
    EXPECT_EQ(MappedFile::map(std::make_shared<const FileHandle>(open("/tmp", O_RDONLY))).error().code,
              ErrorCode::bad_field);
}

}  // namespace
}  // namespace oval4d::fields::test
