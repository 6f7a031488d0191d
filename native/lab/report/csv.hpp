#pragma once
/// A CSV file that is there whole or not at all: it is written beside its place and renamed when finished.

#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <sstream>
#include <string>
#include <vector>

namespace haptics::report {

/// Text, number or nothing, as one field.
class Field {
  public:
    Field(const char* text)
        : text_(quoted(text)) {}
    Field(const std::string& text)
        : text_(quoted(text)) {}
    Field(std::string_view text)
        : text_(quoted(std::string(text))) {}
    Field(double number);
    Field(int number)
        : text_(std::to_string(number)) {}
    Field(bool yes)
        : text_(yes ? "1" : "0") {}
    [[nodiscard]] const std::string& text() const { return text_; }

  private:
    static std::string quoted(const std::string& text);
    std::string text_;
};

/// Rows of a CSV file by column name; none when there is no such file. Numbers that are not there are nan.
class CsvRows {
  public:
    explicit CsvRows(const std::filesystem::path& path);
    [[nodiscard]] std::size_t size() const { return rows_.size(); }
    /// Throws std::runtime_error, which names the column, when there is none of that name.
    [[nodiscard]] const std::string& text(std::size_t row, const char* column) const;
    [[nodiscard]] double number(std::size_t row, const char* column) const;

  private:
    [[nodiscard]] std::size_t find(const char* column) const;
    std::string name_;
    std::vector<std::string> columns_;
    std::vector<std::vector<std::string>> rows_;
};

class CsvFile {
  public:
    CsvFile(std::filesystem::path path, std::initializer_list<const char*> columns);
    void row(const std::vector<Field>& fields);
    /// Puts the file in its place; throws std::runtime_error when it cannot be written.
    void finish();

  private:
    std::filesystem::path path_;
    std::ofstream out_;
    std::size_t columns_;
};

} // namespace haptics::report
