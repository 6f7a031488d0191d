#pragma once
/// Constants of a linkage, compiled from a LinkageSpec: links that are fixed together become one body, so
/// that every body has at least one freedom. Slot 0 of the body arrays is the ground; bodies
/// are 1..body_count, parents before children.

#include <haptics/core/dynamics/linkage_fault.hpp>
#include <haptics/core/dynamics/linkage_spec.hpp>
#include <haptics/core/dynamics/slots.hpp>

namespace haptics {

/// Chains of at least this many bodies use the four-lane kernel.
inline constexpr int k_split_chain_minimum = 5;

/// Length of the body arrays: ground, 64 bodies, and padding that keeps the arrays off power-of-two spacing.
inline constexpr int k_body_slots = 68;

/// Array with one number for each body slot.
using BodyNumbers = Slots<double, k_body_slots>;

/// Vector with one number for each freedom; inline storage, never allocates.
using LinkageVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, k_max_freedoms, 1>;
/// Square matrix over the freedoms; inline storage, never allocates.
using LinkageMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, k_max_freedoms, k_max_freedoms>;

/// How a body is attached.
enum class BodyJoint : std::uint8_t { revolute, prismatic, floating };

/// Constants of one moving body.
struct BodyModel {
    BodyJoint joint{BodyJoint::revolute};
    /// Slot of the parent body, 0 is the ground.
    int parent{0};
    /// First freedom of the joint (a floating base has freedoms 0, 1, 2).
    int freedom{0};
    /// Origin of the body's frame in the parent's frame at coordinate 0, m.
    Vec2 origin{0.0, 0.0};
    /// Sliding direction in the parent's frame, unit vector (prismatic).
    Vec2 axis{1.0, 0.0};
    /// Mass in kg, inertia about the center of mass in kg m^2, center of mass in the body's frame in m.
    double mass{0.0};
    double inertia{0.0};
    Vec2 center{0.0, 0.0};
};

/// Where a link sits in its body.
struct LinkModel {
    /// Slot of the body that carries the link, 0 when it is fixed to the ground.
    int slot{0};
    /// Frame of the link in the body's frame: origin in m, angle in rad with its cosine and sine.
    Vec2 origin{0.0, 0.0};
    double angle{0.0};
    double cosine{1.0};
    double sine{0.0};
    /// As in the LinkSpec.
    double mass{0.0};
    double inertia{0.0};
    Vec2 center{0.0, 0.0};
};

/// Which forward dynamics fits the linkage.
enum class DynamicsKernel : std::uint8_t {
    rigid_body,   ///< one floating body
    closed_chain, ///< grounded revolute chain of 1 to 4 bodies
    split_chain,  ///< long revolute chain, grounded or floating: four lanes
    articulated,  ///< every other tree
};

/// Constants of a serial revolute chain in absolute angles; see closed_chain.hpp.
struct ChainModel {
    /// Joint to next joint, in the body's frame, m.
    BodyNumbers link_x{}, link_y{};
    /// First moment of the body and of all masses beyond it, kg m.
    BodyNumbers moment_x{}, moment_y{};
    /// Diagonal of the mass matrix in absolute angles, kg m^2.
    BodyNumbers diagonal{};
    /// For the pairs 0-1, 1-2, 0-2 of the first three bodies: l_i . mu_j and mu_j x l_i with all joints at 0,
    /// kg m^2. See short_chain.cpp.
    double pair_along[3]{};
    double pair_across[3]{};
};

/// Most steps of a lane of the split chain, the start included.
inline constexpr int k_split_steps = 18;

/// Constants of one step of the split chain: a body in each of four lanes.
struct SplitStep {
    /// Slot whose pose is read, and where the angular acceleration goes.
    int slot[4]{};
    int target[4]{};
    /// From the center of mass to the joints where the lane enters and leaves the body, body axes, m.
    double entry_x[4]{}, entry_y[4]{}, exit_x[4]{}, exit_y[4]{};
    /// 1/kg, 1/(kg m^2); zero stands for the ground.
    double inverse_mass[4]{}, inverse_inertia[4]{};
    /// 1, or 0 for a lane that idles in the last step.
    double active[4]{};
};

/// Layout of the split chain, see split_chain.cpp.
struct SplitModel {
    /// Steps of the longest lane; the last one idles in some lanes when `idle`.
    int steps{0};
    bool idle{false};
    Slots<SplitStep, k_split_steps> step;
};

/// Constants of a linkage. Pointer-free; shared by any number of LinkageData.
struct LinkageModel {
    bool floating{false};
    bool coriolis{true};
    bool has_gravity{false};
    /// Any joint has a spring, damping, friction or limits.
    bool has_passive{false};
    Vec2 gravity{0.0, 0.0};
    int link_count{0};
    int body_count{0};
    int freedoms{0};
    DynamicsKernel kernel{DynamicsKernel::articulated};
    Slots<LinkModel, k_max_links> link;
    Slots<BodyModel, k_body_slots> body;
    /// Angle of body s = angle of its parent + turn_offset + turn_gain * q[turn_freedom].
    Slots<int, k_body_slots> turn_parent{};
    Slots<int, k_body_slots> turn_freedom{};
    BodyNumbers turn_offset{};
    BodyNumbers turn_gain{};
    /// Passive properties of each freedom (those of a floating base are all zero).
    Slots<JointSpec, k_max_freedoms> passive;
    /// Reciprocals of mass and inertia.
    BodyNumbers inverse_mass{};
    BodyNumbers inverse_inertia{};
    ChainModel chain;
    SplitModel split;
    /// The bodies form one serial revolute chain, so that `chain` holds.
    bool is_chain{false};
};

/// Compiles `spec`. Returns the faults and leaves `model` alone when there are any. Allocates: not for the
/// loop.
[[nodiscard]] std::vector<LinkageFault> build_model(const LinkageSpec& spec, LinkageModel& model);

} // namespace haptics
