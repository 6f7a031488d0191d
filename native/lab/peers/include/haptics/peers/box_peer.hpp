#pragma once
/// A box that a hand moves among fixed boxes, in another engine. Plain numbers only, as in chain_peer.hpp.

#include <memory>
#include <string>
#include <vector>

namespace haptics::peers {

/// An upright box that does not move.
struct FixedBox {
    /// Center and half sides, m.
    double x{0.0};
    double y{0.0};
    double half_x{0.0};
    double half_y{0.0};
};

/// The scene: no gravity, no friction, no rebound.
struct BoxPlan {
    /// The moving box: half sides (m), mass (kg), inertia about its center (kg m^2), pose at the start
    /// (m, m, rad).
    double half_x{0.0};
    double half_y{0.0};
    double mass{0.0};
    double inertia{0.0};
    double start[3]{0.0, 0.0, 0.0};
    std::vector<FixedBox> fixed;
    /// Step, s: what contact parameters are chosen by.
    double time_step{0.0};
};

/// Poses are x, y, angle of the center.
class BoxPeer {
  public:
    BoxPeer() = default;
    BoxPeer(const BoxPeer&) = delete;
    BoxPeer& operator=(const BoxPeer&) = delete;
    virtual ~BoxPeer() = default;

    virtual void state(double* pose, double* velocity) const = 0;
    /// One step under a force at the center (N, N, N m).
    virtual void step(const double* force) = 0;
};

/// One way to simulate it.
struct BoxWay {
    std::string name;
    /// How it is set up, for a person.
    std::string setup;
    std::unique_ptr<BoxPeer> (*make)(const BoxPlan& plan){nullptr};
    /// Why it is not in this build; empty when it is.
    std::string missing;
};

/// All ways, ours first, present or not.
[[nodiscard]] std::vector<BoxWay> all_box_ways();

} // namespace haptics::peers
