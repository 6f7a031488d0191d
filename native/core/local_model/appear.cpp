// What appears around the tool.
//
// It fades in (fading.cpp), but a spring that grows around a tool at the depth d would push it with up to K d
// and throw it out: 15000 N/m at 2 mm, 30 N. So what the scene moves appears beside the tool, moved out of it
// by the shortest way until it just touches, and goes to its place from there on the path of an offset, which
// takes the tool along: in the time in which a correction by d changes no force too fast (gentle.cpp), and
// not faster than k_push_out. A tool that presses on it meets it where it is, with all its stiffness once it
// has faded in.
//
// What replaces its like, or lies beside what the tool presses on already, is as deep as that contact and is
// not moved by that.

#include "appear.hpp"

#include <haptics/core/contact/overlap.hpp>

#include <algorithm>

#include "fading.hpp"
#include "gentle.hpp"

namespace haptics::local {
namespace {

// speed at which a tool is pushed out, at most, m/s
constexpr double k_push_out = 0.1;
// overlap that stays, so that it counts as standing in it, m
constexpr double k_touch = 1e-6;
// ways out of several pieces that are followed one after the other
constexpr int k_ways = 4;
constexpr double k_same_way = 0.99;

// how deep the link presses on something in that direction
double pressed(const Data& data, std::int32_t link, const Vec2& way_out) {
    double depth = 0.0;
    for (std::int32_t k = 0; k < data.patches.count; ++k) {
        const Patch& p = data.patches.patch[static_cast<std::size_t>(k)];
        if (p.body_a != link || p.memory.state == ContactState::none || p.normal.dot(way_out) < k_same_way)
            continue;
        for (std::int32_t n = 0; n < p.point_count; ++n)
            depth = std::max(depth, -p.point[static_cast<std::size_t>(n)].gap);
    }
    return depth;
}

} // namespace

void appear(Data& data, std::int32_t i) {
    const auto index = static_cast<std::size_t>(i);
    Track& t = data.track[index];
    Body& body = data.neighbors.body[index];
    set_presence(0.0, t, body);
    if (!t.driven)
        return;
    const Pose place = body.pose;
    double time = 0.0;
    for (int way = 0; way < k_ways; ++way) {
        double most = 0.0;
        Vec2 back{0.0, 0.0};
        for (std::int32_t link = 0; link < data.tool.body_count; ++link) {
            Vec2 out;
            const double depth = deepest_overlap(data.tool, link, data.neighbors, i, out);
            const double moved = depth > 0.0 ? depth - pressed(data, link, out) - k_touch : 0.0;
            if (moved <= most)
                continue;
            most = moved;
            back = -moved * out;
            const Surface surface = surface_between(data.tool.body[static_cast<std::size_t>(link)], body);
            time = std::max({time, gentle_time(data, surface, moved), moved / k_push_out});
        }
        if (most <= 0.0)
            break;
        body.pose.head<2>() += back;
    }
    t.offset.pose = body.pose - place;
    if (t.offset.pose.isZero(0.0))
        return;
    t.blend = std::max(t.tick, time);
}

bool is_arriving(const Track& t, double time) {
    return !t.leaving && t.presence < 1.0 && t.blend > t.tick && time < t.taken + t.blend &&
           !t.offset.is_zero();
}

} // namespace haptics::local
