// Runs each fuzzer on the stored inputs of its corpus, without libFuzzer. The corpus is in
// tests/fuzz/corpus/<subject>/. Each file in it is a test.

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "support.hpp"

namespace fs = std::filesystem;

#define FUZZER(subject) int fuzz_##subject(const std::uint8_t* data, std::size_t size);
#include "fuzzers.inc"
#undef FUZZER

namespace {

using Fuzzer = int (*)(const std::uint8_t* data, std::size_t size);

// Returns the fuzzers by subject.
const std::map<std::string, Fuzzer>& fuzzers() {
    static const std::map<std::string, Fuzzer> all{
#define FUZZER(subject) {#subject, fuzz_##subject},
#include "fuzzers.inc"
#undef FUZZER
    };
    return all;
}

// An exception that ends the execution of an input. It is not derived from std::exception, because fuzzers catch such
// exceptions.
struct InputFailed {};

fs::path corpora() { return fs::path(OVAL4D_SOURCE_DIR) / "tests/fuzz/corpus"; }

// Returns the inputs of a corpus, ordered by name. Returns no inputs if the corpus does not exist.
std::vector<fs::path> inputsOf(const std::string& subject) {
    std::vector<fs::path> inputs;
    if (!fs::is_directory(corpora() / subject)) return inputs;
    for (const auto& entry : fs::directory_iterator(corpora() / subject)) inputs.push_back(entry.path());
    std::ranges::sort(inputs);
    return inputs;
}

// Returns the name of the test for an input. It is the file's name, with "_" in place of characters that have a meaning
// in test filters.
std::string testNameOf(const fs::path& input) {
    std::string name = input.filename();
    const auto isPlain = [](unsigned char c) { return std::isalnum(c) != 0; };
    std::ranges::replace_if(name, [&](char c) { return !isPlain(static_cast<unsigned char>(c)); }, '_');
    return name;
}

class CorpusTest : public testing::Test {
  public:
    CorpusTest(Fuzzer fuzzer, fs::path input) : fuzzer_(fuzzer), input_(std::move(input)) {}
    void TestBody() override {
        std::ifstream file(input_, std::ios::binary);
        ASSERT_TRUE(file) << input_ << " cannot be read";
        const std::vector<char> bytes(std::istreambuf_iterator<char>(file), {});
        try {
            EXPECT_EQ(fuzzer_(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()), 0);
        } catch (const InputFailed&) {  // reportFault() has reported the failure
        }
    }

  private:
    const Fuzzer fuzzer_;
    const fs::path input_;
};

TEST(Corpora, EachBelongsToAFuzzer) {
    for (const auto& entry : fs::directory_iterator(corpora()))
        EXPECT_TRUE(fuzzers().contains(entry.path().filename())) << entry.path() << " has no fuzzer";
}

TEST(Corpora, EachFuzzerHasOne) {
    for (const auto& [subject, fuzzer] : fuzzers()) {
        std::set<std::string> names;
        for (const fs::path& input : inputsOf(subject))
            EXPECT_TRUE(names.insert(testNameOf(input)).second) << input << " differs from another one only in signs";
        EXPECT_FALSE(names.empty()) << "tests/fuzz/corpus/" << subject << " has no files";
    }
}

}  // namespace

namespace oval4d::fuzz {

[[noreturn]] void reportFault(const std::string& message) {
    ADD_FAILURE() << message;
    throw InputFailed{};
}

}  // namespace oval4d::fuzz

int main(int count, char** arguments) {
    testing::InitGoogleTest(&count, arguments);
    for (const auto& each : fuzzers()) {
        const auto& [subject, fuzzer] = each;
        for (const fs::path& input : inputsOf(subject)) {
            testing::RegisterTest(subject.c_str(), testNameOf(input).c_str(), nullptr, nullptr, input.c_str(), 1,
                                  [run = fuzzer, input]() -> CorpusTest* { return new CorpusTest(run, input); });
        }
    }
    return RUN_ALL_TESTS();
}
