#pragma once
/// The engines behind the interface of chain_peer.hpp; which of them are here is told by peers.hpp.

#include <haptics/peers/chain_peer.hpp>

#include <memory>
#include <string>

namespace haptics::peers {

/// MuJoCo's own step: Euler, every feature that can be switched off is off.
std::unique_ptr<ChainPeer> make_mujoco_chain(const ChainPlan& plan);
/// Only the stages of MuJoCo that forward dynamics needs, called one by one: what its interface allows at
/// best.
std::unique_ptr<ChainPeer> make_mujoco_stages_chain(const ChainPlan& plan);
std::string mujoco_version();

/// Pinocchio's articulated-body algorithm on doubles, its data set aside before.
__attribute__((visibility("default"))) std::unique_ptr<ChainPeer> make_pinocchio_chain(const ChainPlan& plan);
__attribute__((visibility("default"))) std::string pinocchio_version();

/// Bodies of 1 unit to 0.1 m without shapes, warm starting on, sleep and continuous collision off.
struct Box2dIterations {
    /// As Box2D's manual suggests.
    int velocity{8};
    int position{3};
};
std::unique_ptr<ChainPeer> make_box2d_chain(const ChainPlan& plan, const Box2dIterations& iterations);
std::string box2d_version();

} // namespace haptics::peers
