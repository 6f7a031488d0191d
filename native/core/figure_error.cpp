#include <haptics/core/figure_error.hpp>

#include <iterator>
#include <sstream>
#include <utility>

namespace haptics {

std::string FigureError::message() const {
    std::ostringstream out;
    out.precision(6);
    const std::string of = unit.empty() ? "" : " " + unit;
    out << field << " is " << value << of;
    if (problem == FigureProblem::not_finite)
        out << ", which is not a number";
    else
        out << ", must lie between " << minimum << " and " << maximum << of;
    out << ". " << remedy;
    return out.str();
}

bool FigureCheck::range(const char* field, double value, double minimum, double maximum, const char* unit,
                        const char* remedy) {
    const bool finite = std::isfinite(value);
    if (finite && value >= minimum && value <= maximum)
        return true;
    FigureError error{finite ? FigureProblem::out_of_range : FigureProblem::not_finite,
                      prefix_ + field,
                      value,
                      minimum,
                      maximum,
                      unit,
                      remedy};
    // one property may stand for several directions
    const std::string text = error.message();
    for (const FigureError& said : errors_)
        if (said.message() == text)
            return false;
    errors_.push_back(std::move(error));
    return false;
}

void FigureCheck::inconsistent(const char* field, double value, double minimum, double maximum,
                               const char* unit, const char* remedy) {
    errors_.push_back({FigureProblem::inconsistent, prefix_ + field, value, minimum, maximum, unit, remedy});
}

void FigureCheck::append(std::vector<FigureError> errors) {
    errors_.insert(errors_.end(), std::make_move_iterator(errors.begin()),
                   std::make_move_iterator(errors.end()));
}

} // namespace haptics
