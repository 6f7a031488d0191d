#pragma once
/// The local model of interaction: one haptic step of the proxy and of what it touches.

#include <haptics/core/local_model/data.hpp>
#include <haptics/core/local_model/model.hpp>

#include <array>
#include <cstdint>
#include <memory>

namespace haptics {

/// What the hand does to the proxy during one step.
struct HandInput {
    /// False: nobody holds the tool; the coupling is off.
    bool held{false};
    /// Where the hand wants the grip to be at the end of the step (scene frame).
    Pose target{0.0, 0.0, 0.0};
    Twist target_velocity{0.0, 0.0, 0.0};
    /// Coupling stiffness (N/m, N/m, N m/rad) and damping (N s/m, N s/m, N m s/rad) per freedom.
    Vec3 stiffness{0.0, 0.0, 0.0};
    Vec3 damping{0.0, 0.0, 0.0};
    /// Most force and torque that the coupling may give (what the device can answer with), N and N m.
    double max_force{1e300};
    double max_torque{1e300};
    /// Share of the coupling that takes effect, 0..1: below 1 while the output gate fades or clamps, so that
    /// the proxy receives the force that was applied and not the one commanded.
    double share{1.0};
    /// Force of the hand fed forward to the grip (four channels), N, N, N m.
    Wrench force{0.0, 0.0, 0.0};
};

/// What a game may want to hear of.
enum class ContactEventKind : std::uint8_t {
    began,  ///< the first touch between the tool and a body
    ended,  ///< the last patch with a body opened, or the body left
    impact, ///< a collision was resolved (state colliding)
    slip,   ///< a sticking patch began to slide
};

struct ContactEvent {
    ContactEventKind kind{ContactEventKind::began};
    /// Body::id of the neighbor.
    std::uint64_t body{0};
    /// Loop-clock time, s.
    double time{0.0};
    /// Where, and the normal out of the neighbor, scene axes (x, y); plain numbers, so that events cross
    /// threads by copying.
    std::array<double, 2> position{0.0, 0.0};
    std::array<double, 2> normal{0.0, 1.0};
    /// Normal impulse of an impact, N s; 0 otherwise.
    double impulse{0.0};
};

/// What a step did, in figures.
struct StepFigures {
    /// Coupling force on the proxy at the grip, mean of the step.
    Wrench coupling{0.0, 0.0, 0.0};
    /// The same at full share: the device is commanded its opposite, and the gate takes its own part.
    Wrench full_coupling{0.0, 0.0, 0.0};
    /// Sum of contact forces and gravity on a rigid tool about the grip, mean of the step; contact forces
    /// alone for a linkage (what the hand has to hold of them depends on its joints: grip_acceleration).
    Wrench environment{0.0, 0.0, 0.0};
    /// Contact forces on all links, about the grip.
    Wrench contact{0.0, 0.0, 0.0};
    /// J_h D^-1 (tau - C): what the grip's acceleration without the hand owes to forces, mean of the step:
    /// contacts, gravity, limits, springs, damping and friction of joints, Coriolis and centrifugal terms.
    Vec3 grip_acceleration{0.0, 0.0, 0.0};
    /// J_h' q': what it owes to the motion itself, mean of the step.
    Vec3 grip_bias{0.0, 0.0, 0.0};
    /// J_h D^-1 J_h^T at the grip (rows of freedoms that are not held are zero).
    Mat3 grip_mobility{Mat3::Zero()};
    /// Velocity change of the grip by collisions in this step (eq. 6 seen at the hand), m/s, m/s, rad/s.
    Twist grip_velocity_jump{0.0, 0.0, 0.0};
    /// Collision impulse on the tool about the grip, N s.
    Wrench collision_impulse{0.0, 0.0, 0.0};
    /// Contacts by state (patches that touch), collisions resolved in the step, deepest overlap (m).
    int contacts{0};
    int colliding{0};
    int sticking{0};
    int sliding{0};
    double max_penetration{0.0};
    /// Energy at the end of the step in the tool's motion, in the contact springs on it and in the coupling,
    /// J.
    double stored_energy{0.0};
    /// Work of the step on the tool by gravity and by what it touches (moving walls, movable neighbors), J:
    /// not that of the hand's force channel.
    double source_work{0.0};
    /// Net normal impulse of collisions along all patches, N s (sizes added).
    double impulse_size{0.0};
    int events_dropped{0};
    /// Contact integrator or collision solver reached its bound and used the fallback.
    bool fell_back{false};
    /// The exact integrator did not apply to the whole step, and the linearly implicit one did the rest
    /// (`fell_back` is set too).
    bool exact_gave_way{false};
    /// The state left all bounds (beyond 1000 km, faster than 1000 km/s, not a number) and was put back to
    /// the start of the step, at rest; all other figures are zero.
    bool diverged{false};
};

struct StepOutput : StepFigures {
    static constexpr int k_max_events = 16;
    /// Events of the step in the order of their patches: the first `event_count` are set.
    int event_count{0};
    std::array<ContactEvent, k_max_events> event;

    /// As new, but for the events beyond `event_count`, which mean nothing.
    void clear() {
        std::construct_at(static_cast<StepFigures*>(this)); // in place: a copy of a new one takes longer
        event_count = 0;
    }
};

/// Puts the proxy somewhere at rest and forgets all contacts. `configuration`: the pose of a rigid tool's
/// center of mass, or the coordinates of a linkage (as many as it has freedoms).
void reset(const Model& model, Data& data, const LinkageVector& configuration);

/// The hand takes the tool at another place: a link and a point of it. Motion and contacts go on.
void grab(const Model& model, Data& data, const Grip& grip);

/// Takes a newer snapshot: contact memory and movable bodies survive. Does nothing when the sequence is not
/// newer.
void take_neighborhood(const Neighborhood& neighborhood, Data& data);

/// Time passes without a step (the loop was late): kinematic neighbors go on, proxy and contacts wait.
void pass_time(Data& data, double seconds);

/// Advances the proxy and its movable neighbors by `dt` (s, > 0). Allocation-free and bounded.
void step(const Model& model, Data& data, const HandInput& hand, double dt, StepOutput& output);

/// The same with the contacts of the last step, which are not looked for anew: tells what forces and motion
/// cost alone. For measurements.
void step_without_detection(const Model& model, Data& data, const HandInput& hand, double dt,
                            StepOutput& output);

/// J_h D^-1 J_h^T at the grip for the present pose.
Mat3 grip_mobility(const Model& model, Data& data);

/// Acceleration of the grip that neither hand nor contacts nor joints' springs, limits and friction cause, at
/// the present state: J_h D^-1 (gravity - C) + J_h' q', m/s^2, m/s^2, rad/s^2. After grip_mobility() for the
/// same state. Rows of freedoms that are not held are zero.
Vec3 free_grip_acceleration(const Model& model, Data& data);

/// Contact forces of a rigid tool that is put at `pose` with `velocity` and has no motion of its own: direct
/// rendering, the baseline.
void step_direct(const Model& model, Data& data, const Pose& pose, const Twist& velocity, double dt,
                 StepOutput& output);

/// Pose of the grip for a pose of the center of mass of the held link.
Pose grip_pose(const Grip& grip, const Pose& pose);
/// Pose of the center of mass for a pose of the grip.
Pose center_pose(const Grip& grip, const Pose& at_grip);
/// Velocity of the grip.
Twist grip_velocity(const Grip& grip, const Pose& pose, const Twist& velocity);

} // namespace haptics
