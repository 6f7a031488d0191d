// What appears or leaves while the tool stands in it.
//
// A neighbor that the new snapshot no longer lists but that is touched stays for k_fade seconds, moves on
// along its path, and its presence u falls evenly from 1 to 0; one that appears around the tool grows
// likewise. Stiffness and damping of its contacts are multiplied by the weight 3 u^2 - 2 u^3, so every force
// fades with it. There are no collisions with what fades: it was not run into. As soon as nothing stands in
// it, a leaver is gone and a newcomer is there.
//
// Replacement. Contacts that form one patch add their presences (patch_merge.cpp), so a wall whose like takes
// its place is not felt: what one loses the other gains. For that to hold when the like is replaced in turn
// before it is all there, what left later waits until what left earlier is gone.
//
// Energy. A spring that only gets softer gives no energy, but one that grows around a tool at the depth d
// gives up to K d^2 / 2 and would throw the tool out. So a contact that fades with the weight w has a damper
// more, 4 (1 - u) w sqrt(K m) with the mass m that the contact moves (assemble.cpp): the tool creeps out.
// What the scene moves appears where the tool just touches it, and pushes it out on its way to its place
// (appear.cpp).

#include "fading.hpp"

#include <haptics/core/contact/overlap.hpp>

#include <algorithm>
#include <array>

#include "appear.hpp"

namespace haptics::local {
namespace {

constexpr double k_fade = 0.05;
// presence of what is as good as there but not yet at its place
constexpr double k_arriving = 0.999;

// a patch in contact that has neighbor `i` on one side
bool is_of(const Data& data, const Patch& p, std::int32_t i) {
    const std::int32_t index = i + data.tool.body_count;
    return p.memory.state != ContactState::none && (p.body_a == index || p.body_b == index);
}

bool is_felt(const Data& data, std::int32_t i, std::uint32_t piece) {
    for (std::int32_t k = 0; k < data.patches.count; ++k) {
        const Patch& p = data.patches.patch[static_cast<std::size_t>(k)];
        const bool is_a = p.body_a == i + data.tool.body_count;
        if (is_of(data, p, i) && (is_a ? p.side.piece_a : p.side.piece_b) == piece)
            return true;
    }
    return false;
}

bool lists(const BodySet& set, std::uint64_t id) {
    const auto end = set.body.begin() + set.body_count;
    return std::any_of(set.body.begin(), end, [id](const Body& b) { return b.id == id; });
}

void save(const Data& data, std::int32_t i, Leavers& out) {
    const BodySet& from = data.neighbors;
    Body body = from.body[static_cast<std::size_t>(i)];
    const bool all = out.piece_count + body.piece_count <= Leavers::k_pieces;
    const std::int32_t first = out.piece_count;
    for (std::int32_t k = 0; k < body.piece_count; ++k) {
        const Piece& piece = from.piece[static_cast<std::size_t>(body.first_piece + k)];
        if (out.piece_count < Leavers::k_pieces && (all || is_felt(data, i, piece.id)))
            out.piece[static_cast<std::size_t>(out.piece_count++)] = piece;
    }
    body.first_piece = first;
    body.piece_count = out.piece_count - first;
    const auto slot = static_cast<std::size_t>(out.body_count++);
    out.body[slot] = body;
    out.track[slot] = data.track[static_cast<std::size_t>(i)];
    if (!out.track[slot].leaving)
        out.track[slot].left = data.time;
    out.track[slot].leaving = true;
}

// movables and patches name bodies by index: let them name the same ones after those of `now` moved up, -1
// where a body is gone (detection recalls its patches by their ids)
void rename(const std::array<std::int32_t, k_max_bodies>& now, Data& data) {
    for (std::int32_t i = 0; i < data.movable_count; ++i) {
        std::int32_t& body = data.movable[static_cast<std::size_t>(i)].body;
        body = body < 0 ? body : now[static_cast<std::size_t>(body)];
    }
    const std::int32_t links = data.tool.body_count;
    const auto rename_side = [&](std::int32_t& body) {
        if (body < links)
            return;
        const std::int32_t found = now[static_cast<std::size_t>(body - links)];
        body = found < 0 ? -1 : found + links;
    };
    for (std::int32_t i = 0; i < data.patches.count; ++i) {
        Patch& p = data.patches.patch[static_cast<std::size_t>(i)];
        rename_side(p.body_a);
        rename_side(p.body_b);
    }
}

} // namespace

bool is_stood_in(const Data& data, std::int32_t i) {
    for (std::int32_t k = 0; k < data.tool.body_count; ++k)
        if (overlap(data.tool, k, data.neighbors, i))
            return true;
    for (std::int32_t k = 0; k < data.movable_count; ++k) {
        const std::int32_t other = data.movable[static_cast<std::size_t>(k)].body;
        if (data.movable[static_cast<std::size_t>(k)].row >= 0 && other >= 0 && other != i &&
            overlap(data.neighbors, other, data.neighbors, i))
            return true;
    }
    return false;
}

bool is_touched(const Data& data, std::int32_t i) {
    for (std::int32_t k = 0; k < data.patches.count; ++k)
        if (is_of(data, data.patches.patch[static_cast<std::size_t>(k)], i))
            return true;
    // merged with what it lies beside, it may have no patch of its own name
    return data.patches.count > 0 && is_stood_in(data, i);
}

void save_leavers(const BodySet& next, Data& data) {
    Leavers& out = data.leavers;
    out.body_count = 0;
    out.piece_count = 0;
    for (std::int32_t i = 0; i < data.neighbors.body_count && out.body_count < Leavers::k_bodies; ++i) {
        const Track& t = data.track[static_cast<std::size_t>(i)];
        if (lists(next, data.neighbors.body[static_cast<std::size_t>(i)].id))
            continue;
        if (t.leaving ? t.presence > 0.0 : is_touched(data, i))
            save(data, i, out);
    }
}

void append_leavers(Data& data) {
    BodySet& to = data.neighbors;
    for (std::int32_t i = 0; i < data.leavers.body_count; ++i) {
        Body body = data.leavers.body[static_cast<std::size_t>(i)];
        if (to.body_count == k_max_bodies || to.piece_count + body.piece_count > k_max_pieces)
            return;
        std::copy_n(data.leavers.piece.begin() + body.first_piece, body.piece_count,
                    to.piece.begin() + to.piece_count);
        body.first_piece = to.piece_count;
        to.piece_count += body.piece_count;
        data.track[static_cast<std::size_t>(to.body_count)] = data.leavers.track[static_cast<std::size_t>(i)];
        to.body[static_cast<std::size_t>(to.body_count++)] = body;
    }
}

void end_fades(Data& data) {
    BodySet& set = data.neighbors;
    std::array<std::int32_t, k_max_bodies> now;
    std::int32_t kept = 0;
    for (std::int32_t i = 0; i < set.body_count; ++i) {
        const auto from = static_cast<std::size_t>(i);
        Track& t = data.track[from];
        const bool alone = t.presence < 1.0 && !is_stood_in(data, i);
        const bool left_alone = alone && !is_arriving(t, data.time);
        if (t.leaving && (t.presence <= 0.0 || left_alone)) {
            now[from] = -1;
            continue;
        }
        if (left_alone)
            set_presence(1.0, t, set.body[from]);
        else if (alone) // what it reaches on its way it meets as gently as what it appeared around
            set_presence(0.0, t, set.body[from]);
        now[from] = kept;
        const auto to = static_cast<std::size_t>(kept++);
        if (to == from)
            continue;
        set.body[to] = set.body[from];
        data.track[to] = data.track[from];
    }
    if (kept == set.body_count)
        return;
    rename(now, data);
    data.neighbor_cache.known = false;
    set.body_count = kept; // their pieces stay until the next snapshot
}

void set_presence(double u, Track& track, Body& body) {
    track.presence = body.presence = u;
}

void fade(double dt, Data& data) {
    const auto fades = [&](const Track& t) { return t.leaving ? t.presence > 0.0 : t.presence < 1.0; };
    double first = data.time; // when the first of those that still fade has left
    for (std::int32_t i = 0; i < data.neighbors.body_count; ++i) {
        const Track& t = data.track[static_cast<std::size_t>(i)];
        if (t.leaving && fades(t))
            first = std::min(first, t.left);
    }
    for (std::int32_t i = 0; i < data.neighbors.body_count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        Track& t = data.track[k];
        if (!fades(t) || (t.leaving && t.left > first))
            continue;
        const double change = t.leaving ? -dt / k_fade : dt / k_fade;
        // what arrives is not run into before it is there
        const double most = is_arriving(t, data.time) ? k_arriving : 1.0;
        set_presence(std::clamp(t.presence + change, 0.0, most), t, data.neighbors.body[k]);
    }
}

void weigh_contacts(Data& data) {
    for (std::int32_t i = 0; i < data.patches.count; ++i) {
        Patch& p = data.patches.patch[static_cast<std::size_t>(i)];
        if (p.presence >= 1.0)
            continue;
        const double weight = presence_weight(p.presence);
        p.surface.stiffness *= weight;
        p.surface.damping *= weight;
        if (p.memory.state == ContactState::none)
            p.memory.state = ContactState::sliding;
    }
}

} // namespace haptics::local
