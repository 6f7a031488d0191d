/// Where the lanes of split_chain.cpp find their bodies. Joint j (from 0) carries body slot j + 1; a floating
/// chain has no joint 0. With m joints, three of them (two meeting points, one separator) are left to the end
/// and m - 3 are shared out over the lanes, so that lane lengths differ by at most one.

#include <haptics/core/dynamics/split_chain.hpp>

namespace haptics {
namespace {

/// Puts the body at `slot` into a lane; `upwards` enters it at its own joint.
void place(const LinkageModel& model, SplitStep& step, int lane, int slot, bool upwards) {
    const BodyModel& body = model.body[slot];
    const Vec2 near = -body.center;
    const Vec2 link(model.chain.link_x[slot], model.chain.link_y[slot]);
    const Vec2 far = link - body.center;
    const Vec2& entry = upwards ? near : far;
    const Vec2& exit = upwards ? far : near;
    step.slot[lane] = slot;
    step.entry_x[lane] = entry.x();
    step.entry_y[lane] = entry.y();
    step.exit_x[lane] = exit.x();
    step.exit_y[lane] = exit.y();
    step.inverse_mass[lane] = model.inverse_mass[slot];
    step.inverse_inertia[lane] = model.inverse_inertia[slot];
}

} // namespace

void describe_split_chain(LinkageModel& model) {
    SplitModel& split = model.split;
    const int first_joint = model.floating ? 1 : 0;
    const int last_joint = model.body_count - 1;
    const int shared = last_joint - first_joint + 1 - 3;
    int length[4];
    for (int lane = 0; lane < 4; ++lane) {
        length[lane] = shared / 4 + (lane < shared % 4 ? 1 : 0);
    }
    split.steps = length[0];
    split.idle = shared % 4 != 0;
    const int separator = first_joint + length[0] + 1 + length[1];

    // bodies before each lane's first joint; none for lane 0 of a grounded chain
    for (int i = 0; i <= split.steps; ++i) {
        for (int lane = 0; lane < 4; ++lane) {
            split.step[i].target[lane] = k_body_slots - 1;
            split.step[i].active[lane] = 1.0;
        }
    }
    const int start[4] = {first_joint, separator, separator + 1, last_joint + 1};
    for (int lane = 0; lane < 4; ++lane) {
        const bool upwards = lane % 2 == 0;
        if (start[lane] > 0) {
            place(model, split.step[0], lane, start[lane], upwards);
            split.step[0].target[lane] = start[lane];
        }
        for (int i = 1; i <= split.steps; ++i) {
            SplitStep& step = split.step[i];
            if (i > length[lane]) {
                // idle: any body keeps the arithmetic finite
                place(model, step, lane, model.body_count, upwards);
                step.active[lane] = 0.0;
                continue;
            }
            const int slot = upwards ? start[lane] + i : start[lane] - i;
            place(model, step, lane, slot, upwards);
            step.target[lane] = slot;
        }
    }
}

} // namespace haptics
