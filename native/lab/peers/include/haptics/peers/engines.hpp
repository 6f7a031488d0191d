#pragma once
/// The engines behind the interface of chain_peer.hpp; which of them are here is told by peers.hpp.

#include <haptics/peers/box_peer.hpp>
#include <haptics/peers/chain_peer.hpp>

#include <memory>
#include <string>

namespace haptics::peers {

/// MuJoCo's own step: Euler, every feature that can be switched off is off.
std::unique_ptr<ChainPeer> make_mujoco_chain(const ChainPlan& plan);
/// Only the stages of MuJoCo that forward dynamics needs, called one by one: what its interface allows at
/// best.
std::unique_ptr<ChainPeer> make_mujoco_stages_chain(const ChainPlan& plan);
/// MuJoCo's Runge-Kutta method of fourth order.
std::unique_ptr<ChainPeer> make_mujoco_rk4_chain(const ChainPlan& plan);
/// Contacts at MuJoCo's default time constant (20 ms), and at the shortest that its manual allows (two
/// steps).
std::unique_ptr<BoxPeer> make_mujoco_box(const BoxPlan& plan);
std::unique_ptr<BoxPeer> make_mujoco_stiff_box(const BoxPlan& plan);
std::string mujoco_version();

/// Pinocchio's articulated-body algorithm on doubles, its data set aside before.
__attribute__((visibility("default"))) std::unique_ptr<ChainPeer> make_pinocchio_chain(const ChainPlan& plan);
/// The same in the classical Runge-Kutta method of fourth order.
__attribute__((visibility("default"))) std::unique_ptr<ChainPeer>
make_pinocchio_rk4_chain(const ChainPlan& plan);
__attribute__((visibility("default"))) std::string pinocchio_version();

/// Bodies of 1 unit to 0.1 m without shapes, warm starting on, sleep and continuous collision off.
struct Box2dIterations {
    /// As Box2D's manual suggests.
    int velocity{8};
    int position{3};
};
std::unique_ptr<ChainPeer> make_box2d_chain(const ChainPlan& plan, const Box2dIterations& iterations);
/// A box of 20 mm as 2 units, which is how large Box2D's manual wants it, and as 20 units.
std::unique_ptr<BoxPeer> make_box2d_box(const BoxPlan& plan);
std::unique_ptr<BoxPeer> make_box2d_fine_box(const BoxPlan& plan);
std::string box2d_version();

/// Our local model, linearly implicit and exact.
std::unique_ptr<BoxPeer> make_own_box(const BoxPlan& plan);
std::unique_ptr<BoxPeer> make_own_exact_box(const BoxPlan& plan);

} // namespace haptics::peers
