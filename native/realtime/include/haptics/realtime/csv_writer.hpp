#pragma once
/// Writes rows of numbers as CSV, the same bytes for the same numbers on every machine and in every locale.

#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <vector>

namespace haptics {

/// A CSV file under construction. It is written under a temporary name in the same folder and gets its own
/// name in finish(), so a reader never sees half of it. Numbers are the shortest that read back as the same
/// double; NaN and infinities are "nan", "inf", "-inf". One thread, never the loop: it allocates and writes
/// files.
class CsvWriter {
  public:
    CsvWriter() = default;
    CsvWriter(const CsvWriter&) = delete;
    CsvWriter& operator=(const CsvWriter&) = delete;
    /// An unfinished file is removed.
    ~CsvWriter();

    /// Begins `path` with the header line. False when it cannot be written; error() says why. The folder must
    /// exist.
    bool open(const std::string& path, const std::vector<std::string>& columns);
    /// Adds a line. False after any failure, also an earlier one, or when the row has not as many numbers as
    /// there are columns.
    bool write_row(std::span<const double> row);
    /// Writes what is left and gives the file its name, replacing an older one. False, with no file left
    /// behind, when anything failed.
    bool finish();

    /// What failed, the path, the reason, the fix; empty when all is well.
    [[nodiscard]] const std::string& error() const { return error_; }
    /// Rows written.
    [[nodiscard]] std::uint64_t rows() const { return rows_; }

  private:
    bool flush();
    bool fail(const std::string& what, int error, const std::string& fix);
    void discard();

    std::string path_;
    std::string temporary_path_;
    std::string buffer_;
    std::string error_;
    std::FILE* file_{nullptr};
    std::size_t columns_{0};
    std::uint64_t rows_{0};
};

/// The shortest decimal text that reads back as `value`, appended to `text`.
void append_number(std::string& text, double value);

} // namespace haptics
