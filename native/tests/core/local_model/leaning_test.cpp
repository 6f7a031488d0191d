// A tool that leans on something for a minute while snapshots come and go: the contacts must not notice.

#include <haptics/core/contact/seams.hpp>
#include <haptics/core/local_model/local_model.hpp>
#include <haptics/shared/paper_wall.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <random>

using namespace haptics;

namespace {

enum class Spot { flat, corner, ledge, tip };

struct Solid {
    std::uint64_t id;
    Convex shape;
};

Surface rough() {
    Surface s = shared::paper_surface();
    s.static_friction = 0.6;
    s.dynamic_friction = 0.5;
    return s;
}

// what there is to lean on, cut into pieces; some of it is too far to be touched
std::vector<Solid> solids(Spot place) {
    std::vector<Solid> out;
    const double end = place == Spot::ledge ? 0.004 : 0.1; // a ledge ends under the tool
    const int pieces = 9;
    for (int i = 0; i < pieces; ++i) {
        const double width = (end + 0.1) / pieces;
        out.push_back({static_cast<std::uint64_t>(100 + i),
                       make_box(Vec2(-0.1 + (i + 0.5) * width, -0.01), Vec2(width, 0.02))});
    }
    if (place == Spot::corner)
        for (int i = 0; i < 5; ++i)
            out.push_back({static_cast<std::uint64_t>(200 + i),
                           make_box(Vec2(0.03, 0.01 * i + 0.005), Vec2(0.02, 0.01))});
    for (int i = 0; i < 6; ++i)
        out.push_back({static_cast<std::uint64_t>(300 + i), make_disc(Vec2(0.02 * i, 0.3), 0.005)});
    return out;
}

struct Outcome {
    int colliding{0};
    int not_sticking{0};
    double moved{0.0};
    double anchor_moved{0.0};
    double force_change{0.0};
    int updates{0};
};

Outcome lean(Spot place, BodyKind kind, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const std::vector<Solid> solid = solids(place);
    Model model = shared::box_tool();
    auto data = std::make_unique<Data>();
    const bool tip = place == Spot::tip;
    reset(model, *data, Pose(0.0, tip ? 0.0216 : 0.0101, tip ? 0.6 : 0.0));
    auto n = std::make_unique<Neighborhood>();
    const auto publish = [&](double rate, double late) {
        std::vector<Solid> listed = solid;
        std::shuffle(listed.begin(), listed.end(), random);
        n->bodies.body_count = n->bodies.piece_count = 0;
        for (const Solid& s : listed) {
            if (s.id >= 300 && unit(random) < 0.5)
                continue; // too far to matter: sometimes listed
            // a solid of its own has all its pieces in one body
            if (kind == BodyKind::fixed || n->bodies.body_count == 0)
                shared::add_body(n->bodies, kind == BodyKind::fixed ? s.id : 1, kind, rough(), Pose::Zero());
            shared::add_piece(n->bodies, s.shape);
            n->bodies.piece[static_cast<std::size_t>(n->bodies.piece_count - 1)].id =
                static_cast<std::uint32_t>(s.id);
        }
        mark_seams(n->bodies);
        ++n->sequence;
        n->tick = 1.0 / rate;
        n->time = data->time - late;
        take_neighborhood(*n, *data);
    };
    publish(60.0, 0.0);
    HandInput hand;
    hand.held = true;
    hand.stiffness = Vec3(0.0, 0.0, 20.0);
    hand.damping = Vec3(3.0, 3.0, 0.05);
    hand.target = data->pose;
    StepOutput out;
    Outcome o;
    double next = 0.0;
    Pose settled = Pose::Zero();
    std::vector<double> anchor;
    Wrench last = Wrench::Zero();
    for (int i = 0; i < 62000; ++i) {
        if (data->time >= next) {
            const double rate = 20.0 + 100.0 * unit(random);
            publish(rate, 0.1 * unit(random));
            if (unit(random) < 0.2)
                publish(rate, 0.0); // two at once
            next = data->time + (unit(random) < 0.2 ? 2.0 : 0.3 + unit(random)) / rate;
            o.updates += i >= 2000 ? 1 : 0;
        }
        // pressed in first, then pushed aside, well below the static limit
        const double part = std::clamp((i - 500) / 1000.0, 0.0, 1.0);
        hand.force = Wrench(place == Spot::corner ? 1.5 * part : 0.6 * part, -2.0, 0.0);
        step(model, *data, hand, 0.001, out);
        if (i < 2000) {
            settled = data->pose;
            last = out.contact;
            continue;
        }
        std::vector<double> springs;
        for (int k = 0; k < data->patches.count; ++k)
            if (data->patches.patch[static_cast<std::size_t>(k)].memory.state != ContactState::none)
                springs.push_back(data->patches.patch[static_cast<std::size_t>(k)].memory.slip_spring);
        if (anchor.empty())
            anchor = springs;
        REQUIRE(anchor.size() == springs.size());
        for (std::size_t k = 0; k < anchor.size(); ++k)
            o.anchor_moved = std::max(o.anchor_moved, std::abs(springs[k] - anchor[k]));
        o.colliding += out.colliding;
        o.not_sticking += out.sticking == out.contacts && out.contacts > 0 ? 0 : 1;
        o.moved = std::max(o.moved, (data->pose - settled).head<2>().norm());
        o.force_change = std::max(o.force_change, (out.contact - last).head<2>().norm());
        last = out.contact;
    }
    return o;
}

} // namespace

TEST_CASE("60 s of leaning while snapshots come unevenly: no new collision, no slip, an unmoved anchor") {
    for (const BodyKind kind : {BodyKind::fixed, BodyKind::kinematic})
        for (const Spot place : {Spot::flat, Spot::corner, Spot::ledge, Spot::tip}) {
            const Outcome o = lean(place, kind, 5U + static_cast<unsigned>(place));
            CAPTURE(static_cast<int>(place));
            CAPTURE(static_cast<int>(kind));
            CHECK(o.updates > 2000);
            CHECK(o.colliding == 0);
            CHECK(o.not_sticking == 0);
            CHECK(o.moved < 1e-7);
            CHECK(o.anchor_moved < 1e-7);
            CHECK(o.force_change < 1e-3);
        }
}
