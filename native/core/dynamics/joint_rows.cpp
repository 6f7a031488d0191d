#include <haptics/core/dynamics/joint_rows.hpp>

namespace haptics {

void limit_rows(const LinkageModel& model, const LinkageData& data, double margin, LimitRows& rows) {
    rows.count = 0;
    for (int i = model.floating ? 3 : 0; i < model.freedoms; ++i) {
        const double below = data.position[i] - model.passive[i].lower_limit;
        const double above = model.passive[i].upper_limit - data.position[i];
        if (below < margin && below <= above) {
            rows.row[rows.count++] = {i, 1.0, below};
        } else if (above < margin) {
            rows.row[rows.count++] = {i, -1.0, above};
        }
    }
}

void friction_rows(const LinkageModel& model, FrictionRows& rows) {
    rows.count = 0;
    for (int i = model.floating ? 3 : 0; i < model.freedoms; ++i) {
        if (model.passive[i].friction > 0.0) {
            rows.row[rows.count++] = {i, model.passive[i].friction};
        }
    }
}

} // namespace haptics
