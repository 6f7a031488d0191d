/// Ear clipping (Meisters 1975) cuts the outline into triangles; then every cut whose removal leaves both its
/// ends convex is taken out again (Hertel and Mehlhorn 1983: at most four times as many pieces as needed).
/// Points on a straight line are kept until the end, so that a cut may end on them. O(n^2), which is plenty
/// for drawn outlines.

#include <haptics/core/geometry/decompose.hpp>
#include <haptics/core/geometry/seams.hpp>
#include <haptics/core/geometry/shapes.hpp>

#include <algorithm>
#include <numeric>

namespace haptics {
namespace {

using Loop = std::vector<int>;

struct Cutter {
    const std::vector<Vec2>& p;

    [[nodiscard]] double turn(int a, int b, int c) const { return cross(at(b) - at(a), at(c) - at(b)); }
    [[nodiscard]] const Vec2& at(int i) const { return p[static_cast<std::size_t>(i)]; }

    [[nodiscard]] bool inside(int q, int a, int b, int c) const {
        const auto left = [this](int i, int k, int m) { return cross(at(k) - at(i), at(m) - at(i)) >= 0.0; };
        return left(a, b, q) && left(b, c, q) && left(c, a, q);
    }

    /// Fattest ear first: thin slivers are left for the end.
    [[nodiscard]] std::vector<Loop> triangles() const {
        Loop rest(p.size());
        std::iota(rest.begin(), rest.end(), 0);
        std::vector<Loop> found;
        while (rest.size() > 3) {
            const std::size_t n = rest.size();
            std::size_t best = n;
            double fattest = 0.0;
            for (std::size_t i = 0; i < n; ++i) {
                const int a = rest[(i + n - 1) % n];
                const int b = rest[i];
                const int c = rest[(i + 1) % n];
                const double longest = std::max({(at(b) - at(a)).squaredNorm(), (at(c) - at(b)).squaredNorm(),
                                                 (at(a) - at(c)).squaredNorm()});
                const double fatness = turn(a, b, c) / longest;
                if (fatness <= fattest)
                    continue;
                const bool ear = std::none_of(rest.begin(), rest.end(), [&](int q) {
                    return q != a && q != b && q != c && inside(q, a, b, c);
                });
                if (ear) {
                    best = i;
                    fattest = fatness;
                }
            }
            if (best == n) { // only points on a line are left to cut: drop one
                for (std::size_t i = 0; i < n && best == n; ++i)
                    if (std::abs(turn(rest[(i + n - 1) % n], rest[i], rest[(i + 1) % n])) < 1e-18)
                        best = i;
                if (best == n)
                    best = 0;
                rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(best));
                continue;
            }
            found.push_back({rest[(best + n - 1) % n], rest[best], rest[(best + 1) % n]});
            rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(best));
        }
        if (turn(rest[0], rest[1], rest[2]) > 0.0)
            found.push_back(rest);
        return found;
    }

    /// Whether another loop has the same edge the other way round.
    [[nodiscard]] static bool is_cut(const std::vector<Loop>& loops, int from, int to) {
        return std::any_of(loops.begin(), loops.end(), [&](const Loop& loop) {
            const auto it = std::find(loop.begin(), loop.end(), to);
            if (it == loop.end())
                return false;
            return (it + 1 == loop.end() ? loop.front() : *(it + 1)) == from;
        });
    }

    /// Joins two loops over a common edge when the result is convex and small enough.
    [[nodiscard]] bool join(const Loop& one, const Loop& two, Loop& joined) const {
        const std::size_t n = one.size();
        const std::size_t m = two.size();
        if (n + m - 2 > static_cast<std::size_t>(k_max_vertices))
            return false;
        for (std::size_t i = 0; i < n; ++i) {
            const int a = one[i];
            const int b = one[(i + 1) % n];
            const auto it = std::find(two.begin(), two.end(), b);
            if (it == two.end())
                continue;
            const auto k = static_cast<std::size_t>(it - two.begin());
            if (two[(k + 1) % m] != a)
                continue;
            joined.clear();
            for (std::size_t s = 0; s < n; ++s)
                joined.push_back(one[(i + 1 + s) % n]); // b ... a
            for (std::size_t s = 2; s < m; ++s)
                joined.push_back(two[(k + s) % m]); // after a, up to before b
            const std::size_t total = joined.size();
            for (std::size_t s = 0; s < total; ++s)
                if (turn(joined[s], joined[(s + 1) % total], joined[(s + 2) % total]) < 0.0)
                    return false;
            return true;
        }
        return false;
    }
};

} // namespace

Decomposition decompose(std::span<const Vec2> outline, double rounding) {
    Decomposition result;
    const CheckedOutline checked = validate_outline(outline);
    result.error = checked.error;
    result.where = checked.where;
    if (checked.error != OutlineError::none)
        return result;
    const int n = static_cast<int>(checked.points.size());
    if (n <= k_max_vertices && is_convex(checked.points)) {
        result.pieces.push_back(make_convex(checked.points, rounding));
        return result;
    }

    const Cutter cutter{checked.points};
    std::vector<Loop> loops = cutter.triangles();
    Loop joined;
    for (std::size_t i = 0; i < loops.size();) {
        bool grown = false;
        for (std::size_t k = i + 1; k < loops.size() && !grown; ++k) {
            if (!cutter.join(loops[i], loops[k], joined))
                continue;
            loops[i] = joined;
            loops.erase(loops.begin() + static_cast<std::ptrdiff_t>(k));
            grown = true;
        }
        if (!grown)
            ++i;
    }

    // cuts are hidden (what a point on a line leaves over is found by mark_seams)
    for (const Loop& loop : loops) {
        std::vector<Vec2> points;
        std::uint16_t hidden = 0;
        for (std::size_t i = 0; i < loop.size(); ++i) {
            points.push_back(cutter.at(loop[i]));
            if (cutter.is_cut(loops, loop[i], loop[(i + 1) % loop.size()]))
                hidden = static_cast<std::uint16_t>(hidden | (1U << i));
        }
        result.pieces.push_back(make_convex(points, rounding, hidden));
    }
    std::vector<SeamPiece> solid;
    for (Convex& piece : result.pieces)
        solid.push_back({&piece, Pose{0.0, 0.0, 0.0}, 0});
    mark_seams(solid);
    return result;
}

} // namespace haptics
