#include <haptics/realtime/csv_writer.hpp>

#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <system_error>

namespace haptics {

namespace {

constexpr std::size_t k_buffer_bytes = std::size_t{1} << 16;

// a name with a comma, quote or line break is quoted
void append_name(std::string& text, const std::string& name) {
    if (name.find_first_of(",\"\r\n") == std::string::npos) {
        text += name;
        return;
    }
    text += '"';
    for (const char c : name) {
        text += c;
        if (c == '"') {
            text += c;
        }
    }
    text += '"';
}

std::string fix_for(int error) {
    switch (error) {
    case ENOENT:
    case ENOTDIR:
        return "Make the folder first.";
    case EACCES:
    case EPERM:
    case EROFS:
        return "Choose a folder that you may write to.";
    case ENOSPC:
    case EDQUOT:
        return "Free some space or choose another disk.";
    case EISDIR:
        return "A folder has this name; choose another one.";
    default:
        return "Choose another path.";
    }
}

} // namespace

void append_number(std::string& text, double value) {
    // a NaN's sign is no information, and depends on the processor
    if (std::isnan(value)) {
        text += "nan";
        return;
    }
    std::array<char, 32> digits{};
    const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    text.append(digits.data(), result.ptr);
}

CsvWriter::~CsvWriter() {
    discard();
}

bool CsvWriter::open(const std::string& path, const std::vector<std::string>& columns) {
    discard();
    error_.clear();
    rows_ = 0;
    path_ = path;
    temporary_path_ = path + ".tmp" + std::to_string(getpid());
    columns_ = columns.size();
    if (columns.empty()) {
        return fail("has no columns", 0, "Name at least one column.");
    }
    file_ = std::fopen(temporary_path_.c_str(), "wbe");
    if (file_ == nullptr) {
        const int error = errno;
        return fail("cannot be written", error, fix_for(error));
    }
    buffer_.clear();
    buffer_.reserve(k_buffer_bytes + columns_ * 32);
    for (const std::string& name : columns) {
        if (&name != &columns.front()) {
            buffer_ += ',';
        }
        append_name(buffer_, name);
    }
    buffer_ += '\n';
    return true;
}

bool CsvWriter::write_row(std::span<const double> row) {
    if (file_ == nullptr) {
        return false;
    }
    if (row.size() != columns_) {
        return fail("got a row of " + std::to_string(row.size()) + " numbers for " +
                        std::to_string(columns_) + " columns",
                    0, "Give each row as many numbers as there are columns.");
    }
    for (std::size_t i = 0; i < row.size(); ++i) {
        if (i > 0) {
            buffer_ += ',';
        }
        append_number(buffer_, row[i]);
    }
    buffer_ += '\n';
    ++rows_;
    return buffer_.size() < k_buffer_bytes || flush();
}

bool CsvWriter::finish() {
    if (file_ == nullptr || !flush()) {
        return false;
    }
    // on the disk before the name: a crash must not leave a good name on an empty file
    if (std::fflush(file_) != 0 || fsync(fileno(file_)) != 0) {
        const int error = errno;
        return fail("cannot be written", error, fix_for(error));
    }
    const int closed = std::fclose(file_);
    const int close_error = errno;
    file_ = nullptr;
    if (closed != 0) {
        return fail("cannot be written", close_error, fix_for(close_error));
    }
    if (std::rename(temporary_path_.c_str(), path_.c_str()) != 0) {
        const int error = errno;
        return fail("cannot get its name", error, fix_for(error));
    }
    temporary_path_.clear();
    return true;
}

bool CsvWriter::flush() {
    if (std::fwrite(buffer_.data(), 1, buffer_.size(), file_) != buffer_.size()) {
        const int error = errno;
        return fail("cannot be written", error, fix_for(error));
    }
    buffer_.clear();
    return true;
}

bool CsvWriter::fail(const std::string& what, int error, const std::string& fix) {
    error_ = "CSV file '" + path_ + "' " + what;
    if (error != 0) {
        error_ += " (" + std::generic_category().message(error) + ")";
    }
    error_ += ". " + fix;
    discard();
    return false;
}

void CsvWriter::discard() {
    if (file_ != nullptr) {
        std::fclose(file_);
        file_ = nullptr;
    }
    if (!temporary_path_.empty()) {
        std::remove(temporary_path_.c_str());
        temporary_path_.clear();
    }
}

} // namespace haptics
