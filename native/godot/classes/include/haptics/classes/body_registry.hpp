#pragma once
/// The bodies that the scene has made known to a world: shapes and figures once, poses at every physics tick.

#include <haptics/classes/dictionary_reader.hpp>
#include <haptics/core/local_model/neighborhood.hpp>
#include <haptics/core/local_model/select_near.hpp>

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

namespace haptics {

/// A body with its pieces in the axes of its center of mass.
struct BodySpec {
    Body body;
    std::vector<Piece> pieces;
    /// Bounds of the pieces, same order; set() fills them.
    std::vector<PieceBounds> bounds;
    /// Center of mass in the axes of the scene's node, m.
    Vec2 center{0.0, 0.0};
};

/// Reads one body: kind (fixed, kinematic, movable, tool), mass, inertia (0: from the shapes), center,
/// surface, shapes, rounding.
BodySpec read_body(const godot::Dictionary& from, const std::string& place, const Surface& fallback,
                   Problems& problems);

/// Pose of the center of mass for a pose of the node, and back.
Pose node_to_center(const Pose& node, const Vec2& center);
Pose center_to_node(const Pose& at_center, const Vec2& center);

/// Main thread only.
class BodyRegistry {
  public:
    /// Adds or replaces.
    void set(std::int64_t id, BodySpec spec);
    void remove(std::int64_t id);
    /// A movable body is that link of a linkage beside the tool from now on (Body::linkage). False when it is
    /// unknown or cannot be pushed.
    bool tie(std::int64_t id, std::uint64_t linkage, std::int32_t link);
    [[nodiscard]] const BodySpec* find(std::int64_t id) const;
    [[nodiscard]] std::size_t size() const { return bodies_.size(); }
    void clear() { bodies_.clear(); }
    /// What did not fit in the last snapshot.
    [[nodiscard]] const LeftOut& left_out() const { return left_out_; }

    /// Numbers per body in `states` of build(): node pose (x, y, theta), then velocity of the center of mass
    /// (x, y) and angular velocity.
    static constexpr std::size_t k_state = 8;

    /// Fills the bodies of a snapshot from ids and states with what lies within the discs (all of it without
    /// discs); what does not fit is counted in `overflow`. Returns the places in `ids` of bodies that are
    /// left out because they are unknown or their state is not a number.
    std::vector<std::size_t> build(std::span<const std::int64_t> ids, std::span<const double> states,
                                   std::span<const ReachDisc> discs, Neighborhood& out);

  private:
    void join_fixed(BodySet& set);

    std::unordered_map<std::int64_t, BodySpec> bodies_;
    // seams between fixed bodies are found again only when the set of them changes
    struct Placed {
        std::uint64_t id;
        std::uint32_t piece;
        Pose pose;
        bool operator==(const Placed& other) const {
            return id == other.id && piece == other.piece && pose == other.pose;
        }
    };
    std::vector<Placed> joined_;
    std::vector<Convex> joined_pieces_;
    bool stale_{true};
    LeftOut left_out_;
};

} // namespace haptics
