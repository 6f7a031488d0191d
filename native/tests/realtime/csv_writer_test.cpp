#include <haptics/realtime/csv_writer.hpp>

#include <doctest/doctest.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <charconv>
#include <clocale>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <string>

using haptics::CsvWriter;

namespace {

namespace fs = std::filesystem;

// a folder of its own, removed at the end
class Folder {
  public:
    Folder()
        : path_(fs::temp_directory_path() / ("haptics_csv_" + std::to_string(std::random_device{}()))) {
        fs::create_directories(path_);
    }
    ~Folder() { fs::remove_all(path_); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    [[nodiscard]] std::string file(const std::string& name) const { return (path_ / name).string(); }
    [[nodiscard]] auto count() const {
        return std::distance(fs::directory_iterator(path_), fs::directory_iterator{});
    }

  private:
    fs::path path_;
};

std::string read(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::string number(double value) {
    std::string text;
    haptics::append_number(text, value);
    return text;
}

} // namespace

TEST_CASE("a CSV file holds a header and the shortest numbers") {
    const Folder folder;
    CsvWriter writer;
    REQUIRE(writer.open(folder.file("run.csv"), {"t_s", "force_x_n"}));
    CHECK(writer.write_row(std::array{0.0, 0.1}));
    CHECK(writer.write_row(std::array{0.001, -1e-300}));
    CHECK(writer.write_row(std::array{1.0 / 3.0, std::numeric_limits<double>::infinity()}));
    CHECK(writer.rows() == 3);
    REQUIRE(writer.finish());
    CHECK(read(folder.file("run.csv")) == "t_s,force_x_n\n0,0.1\n0.001,-1e-300\n0.3333333333333333,inf\n");
    CHECK(folder.count() == 1);
}

TEST_CASE("a number read back is the same number, bit for bit") {
    std::mt19937_64 random(7);
    for (int i = 0; i < 20000; ++i) {
        const double value = std::bit_cast<double>(random());
        if (value != value) {
            continue;
        }
        const std::string text = number(value);
        double back = 0.0;
        std::from_chars(text.data(), text.data() + text.size(), back);
        REQUIRE(std::bit_cast<std::uint64_t>(back) == std::bit_cast<std::uint64_t>(value));
    }
    CHECK(number(-0.0) == "-0");
    CHECK(number(std::numeric_limits<double>::quiet_NaN()) == "nan");
    CHECK(number(-std::numeric_limits<double>::quiet_NaN()) == "nan");
}

TEST_CASE("the locale does not change a number") {
    const char* const set = std::setlocale(LC_ALL, "de_DE.UTF-8");
    CHECK(number(0.5) == "0.5");
    static_cast<void>(set);
    std::setlocale(LC_ALL, "C");
}

TEST_CASE("the file has its name only when it is finished, and an older one stays until then") {
    const Folder folder;
    const std::string path = folder.file("run.csv");
    std::ofstream(path) << "old";
    {
        CsvWriter writer;
        REQUIRE(writer.open(path, {"a"}));
        writer.write_row(std::array{1.0});
        CHECK(read(path) == "old");
    }
    CHECK(read(path) == "old");
    CHECK(folder.count() == 1);
}

TEST_CASE("a failure names the path, the reason and the fix, and leaves no file behind") {
    const Folder folder;
    CsvWriter writer;
    const std::string path = folder.file("missing/run.csv");
    CHECK_FALSE(writer.open(path, {"a"}));
    CHECK(writer.error() ==
          "CSV file '" + path + "' cannot be written (No such file or directory). Make the folder first.");
    CHECK_FALSE(writer.write_row(std::array{1.0}));
    CHECK_FALSE(writer.finish());

    fs::create_directory(folder.file("folder.csv"));
    REQUIRE(writer.open(folder.file("folder.csv"), {"a"}));
    CHECK(writer.error().empty());
    CHECK_FALSE(writer.finish());
    CHECK(writer.error().find("A folder has this name") != std::string::npos);

    REQUIRE(writer.open(folder.file("row.csv"), {"a", "b"}));
    CHECK_FALSE(writer.write_row(std::array{1.0}));
    CHECK(writer.error().find("a row of 1 numbers for 2 columns") != std::string::npos);
    CHECK_FALSE(writer.finish());
    CHECK(folder.count() == 1);
}

TEST_CASE("a full disk is told, not passed over") {
    CsvWriter writer;
    // opening happens under a temporary name, so only a real full file system shows this; /dev/full stands in
    // for one
    if (!fs::exists("/dev/full")) {
        return;
    }
    const Folder folder;
    const std::string path = folder.file("run.csv");
    fs::create_symlink("/dev/full", path + ".tmp" + std::to_string(getpid()));
    REQUIRE(writer.open(path, {"a"}));
    for (int i = 0; i < 100000; ++i) {
        if (!writer.write_row(std::array{0.1 * i})) {
            break;
        }
    }
    CHECK_FALSE(writer.finish());
    CHECK(writer.error().find("No space left on device") != std::string::npos);
    CHECK_FALSE(fs::exists(path));
}

TEST_CASE("a large file is written whole") {
    const Folder folder;
    CsvWriter writer;
    REQUIRE(writer.open(folder.file("run.csv"), {"a", "needs,\"quotes\""}));
    for (int i = 0; i < 50000; ++i) {
        REQUIRE(writer.write_row(std::array{0.001 * i, 1.0 / (i + 1)}));
    }
    REQUIRE(writer.finish());
    std::ifstream file(folder.file("run.csv"));
    std::string line;
    int lines = 0;
    std::getline(file, line);
    CHECK(line == "a,\"needs,\"\"quotes\"\"\"");
    std::string last;
    while (std::getline(file, line)) {
        last = line;
        ++lines;
    }
    CHECK(lines == 50000);
    CHECK(last == "49.999,2e-05");
}
