// What a session does for a tool that is a linkage.

#include <haptics/core/control/session.hpp>

#include <algorithm>
#include <cmath>

namespace haptics {

void Session::grab(const Grip& grip) {
    if (grip.link < 0 || grip.link >= data_->tool.body_count || !grip.point.allFinite())
        return;
    hold(false);
    next_grip_ = grip;
    regrab_ = true;
}

void Session::set_rates(const LinkageVector& rates) {
    if (rates.size() != model_->tool.freedoms() || !rates.allFinite())
        return;
    if (model_->tool.articulated)
        data_->linkage.velocity = rates;
    else
        data_->velocity = rates;
    report_linkage();
}

void Session::follow(Session& linkage, std::uint64_t id) {
    // it joined later than the loop began, or the loop left time out
    const double behind = data_->time - linkage.data_->time;
    if (std::abs(behind) > 1e-9)
        linkage.skip(behind);
    follow_linkage(*data_, id, *linkage.model_, *linkage.data_, settings_.step);
}

void Session::end_pushes() {
    haptics::end_pushes(*data_);
}

void Session::push(Session& linkage, std::uint64_t id) {
    push_linkage(*data_, id, *linkage.data_, settings_.step);
}

void Session::report_linkage() {
    if (!model_->tool.articulated)
        return;
    report_.freedoms = model_->tool.linkage.freedoms;
    report_.held_link = data_->grip.link;
    std::copy_n(data_->linkage.position.data(), report_.freedoms, report_.configuration.begin());
    std::copy_n(data_->linkage.velocity.data(), report_.freedoms, report_.configuration_rate.begin());
}

} // namespace haptics
