// What a world tells about a tool that is a linkage, and how its hand takes another link.

#include <haptics/classes/haptic_world.hpp>
#include <haptics/core/dynamics/kinematics.hpp>

namespace haptics {

Vec2 HapticWorld::tool_center() const {
    if (!tool_ || !tool_->articulated)
        return tool_center_;
    return tool_->linkage.link[report_.held_link].center;
}

void HapticWorld::grab(std::int64_t link, const Vec2& point, bool pose, Problems& problems) {
    if (!running() || !tool_->articulated) {
        problems.add("grab() takes hold of another link of a linkage that is the running world's tool.");
        return;
    }
    const LinkageModel& model = tool_->linkage;
    if (link < 0 || link >= model.link_count || !point.allFinite()) {
        problems.add("grab() got link " + std::to_string(link) + "; the linkage has the links 0 to " +
                     std::to_string(model.link_count - 1) + ", and the point must be finite.");
        return;
    }
    Grip grip;
    grip.link = static_cast<std::int32_t>(link);
    grip.point = point - model.link[grip.link].center;
    grip.pose = pose;
    runner_->grab(grip);
}

void HapticWorld::start_beside(HapticWorld& host, std::int64_t id, Problems& problems) {
    if (running())
        return;
    if (!host.running() || host.host_ != nullptr || &host == this) {
        problems.add("start_beside() needs another world that runs by itself.");
        return;
    }
    if (!tool_ || !tool_->articulated || settings_.session.step != host.settings_.session.step) {
        problems.add("Only a linkage of the same rate runs beside another world.");
        return;
    }
    begin(host.realtime_, 0.0, problems);
    if (!running())
        return;
    if (!host.runner_->attach(*runner_, static_cast<std::uint64_t>(id))) {
        problems.add("At most " + std::to_string(HapticRunner::k_max_guests) +
                     " linkages run beside a tool. Let others rest: switch moves_freely off.");
        stop();
        return;
    }
    host_ = &host;
    host.guests_.push_back(this);
}

void HapticWorld::tie_body(std::int64_t body, std::int64_t linkage, std::int64_t link, Problems& problems) {
    if (linkage <= 0 || link < 0 || link >= k_max_links ||
        !bodies_.tie(body, static_cast<std::uint64_t>(linkage), static_cast<std::int32_t>(link)))
        problems.add("Body " + std::to_string(body) + " cannot be link " + std::to_string(link) +
                     " of linkage " + std::to_string(linkage) + ": it is not registered as movable.");
}

std::vector<double> HapticWorld::links() const {
    std::vector<double> out;
    if (!tool_ || !tool_->articulated || report_.freedoms != tool_->linkage.freedoms)
        return out;
    const LinkageModel& model = tool_->linkage;
    LinkageData data;
    reset(model, data);
    for (int i = 0; i < model.freedoms; ++i) {
        data.position(i) = report_.configuration[static_cast<std::size_t>(i)];
        data.velocity(i) = report_.configuration_rate[static_cast<std::size_t>(i)];
    }
    update_kinematics(model, data);
    out.reserve(static_cast<std::size_t>(model.link_count) * k_link_state);
    for (int i = 0; i < model.link_count; ++i) {
        const Pose node = link_pose(model, data, i);
        const Pose center = link_center_pose(model, data, i);
        const Twist velocity = point_velocity(model, data, i, center.head<2>());
        out.insert(out.end(), node.data(), node.data() + 3);
        out.insert(out.end(), velocity.data(), velocity.data() + 3);
        const int slot = model.link[i].slot;
        const BodyModel& body = model.body[slot];
        const bool moves = slot > 0 && body.joint != BodyJoint::floating;
        out.push_back(moves ? data.position(body.freedom) : 0.0);
        out.push_back(moves ? data.velocity(body.freedom) : 0.0);
    }
    return out;
}

} // namespace haptics
