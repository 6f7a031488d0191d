#pragma once
/// A serial revolute chain in another engine. Plain numbers only: an engine may be compiled with its own
/// flags, and what a header like Eigen's compiles to under them must not cross.

#include <memory>
#include <vector>

namespace haptics::peers {

/// One body of the chain. Frames as in a LinkSpec: the body's frame sits at its joint.
struct ChainBody {
    /// Joint in the frame of the body before (in the scene's for the first), m, m, rad.
    double joint_x{0.0};
    double joint_y{0.0};
    double joint_angle{0.0};
    /// kg, and about the center of mass kg m^2.
    double mass{0.0};
    double inertia{0.0};
    /// Center of mass in the body's frame, m.
    double center_x{0.0};
    double center_y{0.0};
};

/// Bodies from the ground outwards. No gravity, no damping, no limits, nothing to touch.
using ChainPlan = std::vector<ChainBody>;

/// The chain as one engine simulates it. Coordinates are the joint angles (rad) and their rates (rad/s),
/// arrays of as many numbers as the plan has bodies.
class ChainPeer {
  public:
    ChainPeer() = default;
    ChainPeer(const ChainPeer&) = delete;
    ChainPeer& operator=(const ChainPeer&) = delete;
    virtual ~ChainPeer() = default;

    virtual void set_state(const double* position, const double* velocity) = 0;
    virtual void get_state(double* position, double* velocity) const = 0;
    /// Joint accelerations at the present state, rad/s^2. False: the engine does not know them.
    virtual bool acceleration(double* result) = 0;
    /// Accelerations, then velocities, then positions with the new velocities, over `time_step` (s).
    virtual void step(double time_step) = 0;
};

} // namespace haptics::peers
