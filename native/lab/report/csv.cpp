#include "csv.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <utility>

namespace haptics::report {

Field::Field(double number) {
    char text[40];
    std::snprintf(text, sizeof text, "%.6g", number);
    text_ = text;
}

std::string Field::quoted(const std::string& text) {
    if (text.find_first_of(",\"\n") == std::string::npos)
        return text;
    std::string safe = "\"";
    for (const char c : text) {
        if (c == '"')
            safe += '"';
        safe += c;
    }
    return safe + '"';
}

namespace {

std::filesystem::path partial(std::filesystem::path path) {
    return path += ".partial";
}

} // namespace

CsvRows::CsvRows(const std::filesystem::path& path)
    : name_(path.filename().string()) {
    std::ifstream in(path);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    std::vector<std::string> line;
    std::string field;
    bool quoted = false;
    const auto end_field = [&] { line.push_back(std::exchange(field, {})); };
    const auto end_line = [&] {
        end_field();
        if (columns_.empty())
            columns_ = std::exchange(line, {});
        else
            rows_.push_back(std::exchange(line, {}));
    };
    for (const char c : text) {
        // a doubled quote leaves and enters again, which drops one of the two
        if (c == '"') {
            if (!quoted && !field.empty())
                field += '"';
            quoted = !quoted;
        } else if (c == ',' && !quoted) {
            end_field();
        } else if (c == '\n' && !quoted) {
            end_line();
        } else if (c != '\r') {
            field += c;
        }
    }
    if (!field.empty() || !line.empty())
        end_line();
}

std::size_t CsvRows::find(const char* column) const {
    const auto at = std::find(columns_.begin(), columns_.end(), column);
    if (at == columns_.end())
        throw std::runtime_error(name_ + " has no column " + column);
    return static_cast<std::size_t>(at - columns_.begin());
}

const std::string& CsvRows::text(std::size_t row, const char* column) const {
    static const std::string none;
    const std::vector<std::string>& fields = rows_.at(row);
    const std::size_t at = find(column);
    return at < fields.size() ? fields[at] : none;
}

double CsvRows::number(std::size_t row, const char* column) const {
    const std::string& from = text(row, column);
    double value = std::numeric_limits<double>::quiet_NaN();
    std::from_chars(from.data(), from.data() + from.size(), value);
    return value;
}

CsvFile::CsvFile(std::filesystem::path path, std::initializer_list<const char*> columns)
    : path_(std::move(path))
    , out_(partial(path_))
    , columns_(columns.size()) {
    const char* separator = "";
    for (const char* column : columns) {
        out_ << separator << column;
        separator = ",";
    }
    out_ << '\n';
}

void CsvFile::row(const std::vector<Field>& fields) {
    if (fields.size() != columns_)
        throw std::logic_error(path_.string() + ": a row with " + std::to_string(fields.size()) + " fields");
    const char* separator = "";
    for (const Field& field : fields) {
        out_ << separator << field.text();
        separator = ",";
    }
    out_ << '\n';
}

void CsvFile::finish() {
    out_.close();
    if (!out_)
        throw std::runtime_error("cannot write " + path_.string());
    std::filesystem::rename(partial(path_), path_);
}

} // namespace haptics::report
