/// A piece's distance is that of its box from the nearest disc, negative inside of it. Pieces are ranked by
/// it only when they do not all fit: they are taken from the nearest on while there is room for the piece
/// and, if it is the first of its body, for the body. The set is then written in the order of the candidates,
/// so that it does not depend on the ranks of what stays.

#include <haptics/core/local_model/select_near.hpp>

#include <algorithm>
#include <limits>
#include <vector>

namespace haptics {
namespace {

struct Ranked {
    double distance;
    std::size_t body;
    std::size_t piece;
};

double distance_to_discs(const PieceBounds& bounds, const Pose& pose, std::span<const ReachDisc> discs) {
    double nearest = discs.empty() ? 0.0 : std::numeric_limits<double>::infinity();
    for (const ReachDisc& disc : discs)
        nearest = std::min(nearest, distance_to(bounds, pose, disc.center) - disc.radius);
    return nearest;
}

std::vector<Ranked> find_near(std::span<const Candidate> candidates, std::span<const ReachDisc> discs) {
    std::vector<Ranked> near;
    for (std::size_t b = 0; b < candidates.size(); ++b) {
        const Candidate& c = candidates[b];
        const std::size_t first = near.size();
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t p = 0; p < c.pieces.size(); ++p) {
            const double distance = distance_to_discs(c.bounds[p], c.body.pose, discs);
            nearest = std::min(nearest, distance);
            if (distance <= 0.0 || c.body.kind == BodyKind::movable)
                near.push_back({distance, b, p});
        }
        if (nearest > 0.0)
            near.resize(first);
    }
    return near;
}

// keeps the nearest that fit
LeftOut cut(std::vector<Ranked>& near, std::size_t bodies) {
    std::vector<std::size_t> order(near.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        order[i] = i;
    std::sort(order.begin(), order.end(), [&near](std::size_t one, std::size_t other) {
        return near[one].distance != near[other].distance ? near[one].distance < near[other].distance
                                                          : one < other;
    });
    enum class Place : std::uint8_t { unseen, in, out };
    std::vector<Place> place(bodies, Place::unseen);
    std::vector<bool> kept(near.size(), false);
    LeftOut left;
    int body_count = 0;
    int piece_count = 0;
    for (const std::size_t i : order) {
        Place& body = place[near[i].body];
        if (body == Place::unseen) {
            body = body_count < k_max_bodies && piece_count < k_max_pieces ? Place::in : Place::out;
            (body == Place::in ? body_count : left.bodies) += 1;
        }
        kept[i] = body == Place::in && piece_count < k_max_pieces;
        (kept[i] ? piece_count : left.pieces) += 1;
    }
    std::vector<Ranked> rest;
    for (std::size_t i = 0; i < near.size(); ++i)
        if (kept[i])
            rest.push_back(near[i]);
    near = std::move(rest);
    return left;
}

} // namespace

double distance_to(const PieceBounds& bounds, const Pose& pose, const Vec2& point) {
    const Vec2 at = rotate(-pose.z(), Vec2(point - pose.head<2>()));
    const double dx = std::max({bounds.low.x() - at.x(), at.x() - bounds.high.x(), 0.0});
    const double dy = std::max({bounds.low.y() - at.y(), at.y() - bounds.high.y(), 0.0});
    return Vec2(dx, dy).norm();
}

LeftOut select_near(std::span<const Candidate> candidates, std::span<const ReachDisc> discs, BodySet& out) {
    std::vector<Ranked> near = find_near(candidates, discs);
    std::size_t bodies = 0;
    for (std::size_t i = 0; i < near.size(); ++i)
        bodies += i == 0 || near[i].body != near[i - 1].body ? 1U : 0U;
    LeftOut left;
    if (near.size() > static_cast<std::size_t>(k_max_pieces) ||
        bodies > static_cast<std::size_t>(k_max_bodies))
        left = cut(near, candidates.size());
    out.body_count = 0;
    out.piece_count = 0;
    for (std::size_t i = 0; i < near.size(); ++i) {
        const Candidate& c = candidates[near[i].body];
        if (i == 0 || near[i].body != near[i - 1].body) {
            Body& next = out.body[static_cast<std::size_t>(out.body_count++)];
            next = c.body;
            next.first_piece = out.piece_count;
            next.piece_count = 0;
        }
        out.piece[static_cast<std::size_t>(out.piece_count++)] = c.pieces[near[i].piece];
        ++out.body[static_cast<std::size_t>(out.body_count - 1)].piece_count;
    }
    return left;
}

} // namespace haptics
