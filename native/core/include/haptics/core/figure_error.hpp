#pragma once
/// A figure that cannot be used: which one, its value, the range it must lie in, and what to do about it.

#include <cmath>
#include <string>
#include <vector>

namespace haptics {

/// What is wrong with a figure.
enum class FigureProblem {
    not_finite,   ///< NaN or infinite
    out_of_range, ///< finite, but outside [minimum, maximum]
    inconsistent, ///< in range on its own, impossible together with others
};

/// One unusable figure. Made off the haptic loop (it owns strings).
struct FigureError {
    FigureProblem problem{FigureProblem::out_of_range};
    /// Dotted name of the member, e.g. "bar[0].distal_length[1]".
    std::string field;
    /// Value found, in `unit`.
    double value{0.0};
    /// Least and largest value allowed, in `unit`.
    double minimum{0.0};
    double maximum{0.0};
    /// SI unit of value, minimum and maximum.
    std::string unit;
    /// What to do, as a sentence.
    std::string remedy;

    /// The whole error as one line for a person.
    [[nodiscard]] std::string message() const;
};

/// Collects the figures of one structure that are out of range.
class FigureCheck {
  public:
    /// Prefix put before every field name, e.g. "bar[1].".
    explicit FigureCheck(std::string prefix = {})
        : prefix_(std::move(prefix)) {}

    /// Books an error unless `value` is finite and lies in [minimum, maximum]. Returns whether it does.
    bool range(const char* field, double value, double minimum, double maximum, const char* unit,
               const char* remedy);
    /// Books a figure that does not fit the others.
    void inconsistent(const char* field, double value, double minimum, double maximum, const char* unit,
                      const char* remedy);
    /// Takes over the errors of a part.
    void append(std::vector<FigureError> errors);
    /// All errors so far, in the order found.
    [[nodiscard]] std::vector<FigureError> take() { return std::move(errors_); }
    /// True while nothing was booked.
    [[nodiscard]] bool good() const { return errors_.empty(); }

  private:
    std::string prefix_;
    std::vector<FigureError> errors_;
};

} // namespace haptics
