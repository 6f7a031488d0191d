/// Groups the pieces of a set into solids; see geometry/seams for what is marked.

#include <haptics/core/contact/seams.hpp>
#include <haptics/core/geometry/seams.hpp>

#include <vector>

namespace haptics {
namespace {

/// Index of the surface among those seen.
int surface_index(std::vector<Surface>& seen, const Surface& surface) {
    for (std::size_t i = 0; i < seen.size(); ++i) {
        if (seen[i] == surface)
            return static_cast<int>(i);
    }
    seen.push_back(surface);
    return static_cast<int>(seen.size()) - 1;
}

void gather(BodySet& set, const Body& body, int group, std::vector<SeamPiece>& solid) {
    for (std::int32_t k = 0; k < body.piece_count; ++k) {
        Piece& piece = set.piece[static_cast<std::size_t>(body.first_piece + k)];
        if (!piece.one_way && piece.convex.count > 0)
            solid.push_back({&piece.convex, body.pose, group});
    }
}

} // namespace

void mark_seams(BodySet& set) {
    std::vector<SeamPiece> fixed;
    std::vector<Surface> surfaces;
    for (std::int32_t i = 0; i < set.body_count; ++i) {
        const Body& body = set.body[static_cast<std::size_t>(i)];
        if (body.kind == BodyKind::fixed) {
            gather(set, body, surface_index(surfaces, body.surface), fixed);
            continue;
        }
        std::vector<SeamPiece> own;
        gather(set, body, 0, own);
        mark_seams(own);
    }
    mark_seams(fixed);
}

} // namespace haptics
