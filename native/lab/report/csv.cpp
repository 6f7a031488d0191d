#include "csv.hpp"

#include <cstdio>
#include <stdexcept>

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
