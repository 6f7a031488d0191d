/// Contact detection: `detection/<scene>`, and the time of impact of one pair.

#include <haptics/core/contact/detection.hpp>
#include <haptics/core/contact/seams.hpp>
#include <haptics/core/contact/time_of_impact.hpp>
#include <haptics/core/geometry/shapes.hpp>

#include <benchmark/benchmark.h>

#include <memory>

namespace {

using namespace haptics;

/// A tool, its neighbors and the memory of the detection.
struct Bench {
    std::unique_ptr<BodySet> tool{std::make_unique<BodySet>()};
    std::unique_ptr<BodySet> neighbors{std::make_unique<BodySet>()};
    std::unique_ptr<BodyCache> tool_cache{std::make_unique<BodyCache>()};
    std::unique_ptr<BodyCache> cache{std::make_unique<BodyCache>()};
    PatchList patches;

    static Body& add(BodySet& set, BodyKind kind, const Pose& pose, const Convex& shape) {
        Body& body = set.body[static_cast<std::size_t>(set.body_count)];
        body.id = static_cast<std::uint64_t>(++set.body_count);
        body.kind = kind;
        body.pose = pose;
        body.first_piece = set.piece_count;
        body.piece_count = 1;
        Piece& piece = set.piece[static_cast<std::size_t>(set.piece_count++)];
        piece.id = 1;
        piece.convex = shape;
        return body;
    }
    void wall(const Vec2& center, const Vec2& size, BodyKind kind = BodyKind::fixed) {
        add(*neighbors, kind, Pose{center.x(), center.y(), 0.0}, make_box(Vec2{0, 0}, size));
    }
    void prepare() {
        mark_seams(*neighbors);
        tool_cache->known = cache->known = false;
    }
    void run(benchmark::State& state) {
        prepare();
        for (auto _ : state) {
            detect_patches(*tool, *tool_cache, *neighbors, *cache, {}, patches, patches);
            benchmark::DoNotOptimize(patches.count);
        }
        state.counters["patches"] = patches.count;
    }
};

Convex tool_box() {
    return make_box(Vec2{0, 0}, Vec2{0.02, 0.01});
}

void box_on_wall(benchmark::State& state) {
    Bench bench;
    Bench::add(*bench.tool, BodyKind::tool, Pose{0, 0.0049, 0}, tool_box());
    bench.wall(Vec2{0, -0.01}, Vec2{0.2, 0.02});
    for (std::int64_t i = 1; i < state.range(0); ++i)
        bench.wall(Vec2{0.5 + 0.1 * static_cast<double>(i), 1.0}, Vec2{0.05, 0.05});
    bench.run(state);
}

void box_on_cut_wall(benchmark::State& state) {
    Bench bench;
    Bench::add(*bench.tool, BodyKind::tool, Pose{0, 0.0049, 0}, tool_box());
    for (std::int64_t i = 0; i < state.range(0); ++i)
        bench.wall(Vec2{0.005 * (static_cast<double>(i) - 0.5 * static_cast<double>(state.range(0))), -0.01},
                   Vec2{0.005, 0.02});
    bench.run(state);
}

void box_in_hole(benchmark::State& state) {
    Bench bench;
    Bench::add(*bench.tool, BodyKind::tool, Pose{0, 0, 0}, make_box(Vec2{0, 0}, Vec2{0.02, 0.01}, 0.001));
    bench.wall(Vec2{0, -0.0149}, Vec2{0.2, 0.02});
    bench.wall(Vec2{0, 0.0149}, Vec2{0.2, 0.02});
    bench.wall(Vec2{-0.0199, 0}, Vec2{0.02, 0.2});
    bench.wall(Vec2{0.0199, 0}, Vec2{0.02, 0.2});
    bench.run(state);
}

void movables_apart(benchmark::State& state) {
    Bench bench;
    Bench::add(*bench.tool, BodyKind::tool, Pose{5, 5, 0}, tool_box());
    for (std::int64_t i = 0; i < state.range(0); ++i)
        bench.wall(Vec2{0.1 * static_cast<double>(i), 1.0}, Vec2{0.05, 0.05}, BodyKind::movable);
    bench.run(state);
}

void impact(benchmark::State& state) {
    Bench bench;
    const Twist twist{1, -10, 20};
    Bench::add(*bench.tool, BodyKind::tool, Pose{0, 0.02, 0.3}, tool_box()).velocity = twist;
    bench.wall(Vec2{0, -0.01}, Vec2{0.2, 0.02});
    bench.prepare();
    DetectionSettings settings;
    settings.step = 0.002;
    detect_patches(*bench.tool, *bench.neighbors, settings, bench.patches, bench.patches);
    for (auto _ : state)
        benchmark::DoNotOptimize(time_of_impact(*bench.tool, *bench.neighbors, bench.patches.patch[0], twist,
                                                Twist{0, 0, 0}, settings.step));
}

BENCHMARK(box_on_wall)->Name("detection/box_on_wall/bodies")->Arg(1)->Arg(64);
BENCHMARK(box_on_cut_wall)->Name("detection/box_on_cut_wall/pieces")->Arg(8);
BENCHMARK(box_in_hole)->Name("detection/box_in_hole");
BENCHMARK(movables_apart)->Name("detection/movables_apart/bodies")->Arg(8)->Arg(64);
BENCHMARK(impact)->Name("detection/time_of_impact");

} // namespace
