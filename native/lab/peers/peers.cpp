#include <haptics/peers/engines.hpp>
#include <haptics/peers/peers.hpp>

// the build defines HAPTICS_PEER_<ENGINE>_MISSING as the reason why an engine is not in it
namespace haptics::peers {
namespace {

// doubles all the way: what remains is rounding, which grows with the chain's condition
constexpr AgreementDemand k_exact{.acceleration = 1e-9, .motion = 1e-8, .steps = 400, .time_step = 1e-4};

[[maybe_unused]] Peer absent(const char* name, const char* reason) {
    Peer peer;
    peer.name = name;
    peer.missing = reason;
    return peer;
}

[[maybe_unused]] Peer exact(const char* name, const std::string& version,
                            std::unique_ptr<ChainPeer> (*make)(const ChainPlan&)) {
    return {name, version, "", make, make, k_exact};
}

} // namespace

std::vector<Peer> all_peers() {
    std::vector<Peer> peers;
#ifdef HAPTICS_PEER_MUJOCO_MISSING
    peers.push_back(absent("mujoco", HAPTICS_PEER_MUJOCO_MISSING));
#else
    peers.push_back(exact("mujoco", mujoco_version(), make_mujoco_chain));
    peers.back().make_rk4 = make_mujoco_rk4_chain;
    peers.push_back(exact("mujoco_stages", mujoco_version(), make_mujoco_stages_chain));
#endif
#ifdef HAPTICS_PEER_PINOCCHIO_MISSING
    peers.push_back(absent("pinocchio", HAPTICS_PEER_PINOCCHIO_MISSING));
#else
    peers.push_back(exact("pinocchio", pinocchio_version(), make_pinocchio_chain));
    peers.back().make_rk4 = make_pinocchio_rk4_chain;
#endif
#ifdef HAPTICS_PEER_BOX2D_MISSING
    peers.push_back(absent("box2d", HAPTICS_PEER_BOX2D_MISSING));
#else
    Peer box2d;
    box2d.name = "box2d";
    box2d.version = box2d_version();
    box2d.make = [](const ChainPlan& plan) { return make_box2d_chain(plan, Box2dIterations{}); };
    box2d.make_converged = [](const ChainPlan& plan) { return make_box2d_chain(plan, {4000, 100}); };
    // single precision, and joints held by iteration
    box2d.demand = {.acceleration = -1.0, .motion = 0.02, .steps = 100, .time_step = 1e-3};
    peers.push_back(box2d);
#endif
    return peers;
}

std::vector<BoxWay> all_box_ways() {
    std::vector<BoxWay> ways{{"ours, linearly implicit", "walls of 1e7 N/m and 20 N s/m", make_own_box, ""},
                             {"ours, exact", "walls of 1e7 N/m and 20 N s/m", make_own_exact_box, ""}};
#ifdef HAPTICS_PEER_MUJOCO_MISSING
    ways.push_back({"mujoco", "", nullptr, HAPTICS_PEER_MUJOCO_MISSING});
#else
    const std::string mujoco =
        "MuJoCo " + mujoco_version() + ", implicitfast, contacts of one dimension, unneeded features off, ";
    ways.push_back({"mujoco, default contacts", mujoco + "solref 0.02 1", make_mujoco_box, ""});
    ways.push_back(
        {"mujoco, stiffest contacts", mujoco + "solref of two steps, 1", make_mujoco_stiff_box, ""});
#endif
#ifdef HAPTICS_PEER_BOX2D_MISSING
    ways.push_back({"box2d", "", nullptr, HAPTICS_PEER_BOX2D_MISSING});
#else
    const std::string box2d =
        "Box2D " + box2d_version() + ", 8 and 3 iterations, warm starting, bullet, no sleep, 1 unit = ";
    ways.push_back({"box2d, 1 unit = 10 mm", box2d + "10 mm", make_box2d_box, ""});
    ways.push_back({"box2d, 1 unit = 1 mm", box2d + "1 mm", make_box2d_fine_box, ""});
#endif
    return ways;
}

} // namespace haptics::peers
