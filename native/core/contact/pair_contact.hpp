#pragma once
/// Contact of one piece with one piece: the normal, the one or two ends of the zone of contact, the side it
/// is felt from.

#include <haptics/core/contact/contact.hpp>
#include <haptics/core/contact/placed_convex.hpp>

#include <cstdint>

namespace haptics::contact {

/// The side that a pair was felt from in the last step, if any, moved to where the bodies stand now.
struct SideHint {
    PatchSide::Face face{PatchSide::Face::none};
    /// Edge of that face on its owner (valid when face is not none).
    int edge{0};
    /// Normal of the last patch, out of b into a (valid when known).
    Vec2 normal{0.0, 0.0};
    bool known{false};
};

/// How a contact was found; a lower rank is believed first.
enum class Rank : std::uint8_t {
    felt,     ///< the closest features are real ones
    followed, ///< the closest feature is a seam: the flat face beside it is taken
    inside,   ///< the piece was entered through a seam: kept only when nothing else holds the body
};

/// One contact of two pieces.
struct PairContact {
    Rank rank{Rank::felt};
    /// Out of b into a.
    Vec2 normal{0.0, 1.0};
    int count{0};
    std::array<PatchPoint, 2> point;
    PatchSide::Face face{PatchSide::Face::none};
    /// Edge of the face's owner.
    int edge{0};
    /// Feature of each side: 0 to 15 an edge, 16 to 31 a vertex.
    int feature_a{0};
    int feature_b{0};
    /// Plane of b's matter: contacts on one plane are one patch.
    Vec2 plane_normal{0.0, 1.0};
    double plane_offset{0.0};
};

/// What is asked of a pair.
struct PairQuery {
    /// Contacts with a larger gap are left out, m.
    double limit{0.0};
    /// b acts only along this scene direction.
    bool one_way{false};
    Vec2 one_way_normal{0.0, 1.0};
    SideHint hint;
};

/// Finds the contact of two pieces; false when there is none within the limit.
bool collide(const PlacedConvex& a, const PlacedConvex& b, const PairQuery& query, PairContact& contact);

/// Signed distance of two pieces and a direction (out of b) that separates them by it. Negative or a lower
/// bound when the cores overlap or nearly touch.
double separate(const PlacedConvex& a, const PlacedConvex& b, Vec2& normal);

} // namespace haptics::contact
