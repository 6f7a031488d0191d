#pragma once
/// One haptic world of the server: settings, bodies, device and the runner. Main thread only.

#include <haptics/classes/body_registry.hpp>
#include <haptics/classes/linkage_reader.hpp>
#include <haptics/classes/world_device.hpp>
#include <haptics/classes/world_settings.hpp>
#include <haptics/realtime/haptic_runner.hpp>
#include <haptics/realtime/histogram.hpp>
#include <haptics/realtime/host_steal.hpp>
#include <haptics/realtime/tick_clock.hpp>

#include <atomic>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace haptics {

/// What the scene reads back about a movable body.
struct GivenImpulse {
    std::int64_t body{0};
    Wrench impulse{0.0, 0.0, 0.0};
};

class HapticWorld {
  public:
    void configure(const godot::Dictionary& settings, Problems& problems);
    void set_tool(const godot::Dictionary& tool, Problems& problems);
    void set_device(const godot::Dictionary& device, Problems& problems);
    void set_body(std::int64_t id, const godot::Dictionary& body, Problems& problems);
    void remove_body(std::int64_t id);

    /// The tick of a snapshot: its length (s), the frame that carries it, and how many ticks a frame brings
    /// at most.
    struct Tick {
        double length{0.0};
        std::int64_t frame{0};
        std::int64_t most{8};
    };
    /// Publishes a snapshot of what lies within the discs; ids that could not be used are named in `problems`
    /// (once each), and so is a snapshot that is full.
    void submit(std::span<const std::int64_t> ids, std::span<const double> states,
                std::span<const ReachDisc> discs, std::span<const std::int64_t> masks, const Tick& when,
                const Vec2& gravity, Problems& problems);
    /// The pieces of the last snapshot, for a picture: body, kind, one_way, half_plane, radius, points (scene
    /// axes, m).
    [[nodiscard]] godot::Array neighborhood() const;
    /// Pieces that did not fit into the last snapshot.
    [[nodiscard]] std::int32_t left_out() const { return shown_.overflow; }
    /// Builds session and runner; starts the thread when `realtime`.
    void start(bool realtime, double record_seconds, Problems& problems);
    /// Joins the thread, and leaves the device without force.
    void stop();
    /// The force that a simulated device had been sent last when the world stopped (N, N, N m).
    [[nodiscard]] const Wrench& last_force() const { return last_force_; }
    [[nodiscard]] bool running() const { return runner_ != nullptr; }
    [[nodiscard]] bool realtime() const { return realtime_; }
    int advance(double seconds);

    /// Takes the newest report in; call once a tick before the getters.
    void refresh();
    [[nodiscard]] const HapticReport& report() const { return report_; }
    /// Impulses that the tool gave since the last call.
    std::vector<GivenImpulse> take_impulses();
    [[nodiscard]] godot::Array take_events();
    /// The scene's part of a physics tick took so long on the main thread, s.
    void book_tick(double seconds);
    [[nodiscard]] godot::Dictionary statistics() const;
    /// Stages of the haptic step: stage, runs, and the reason when it is left out.
    [[nodiscard]] godot::Array plan() const;
    void aim(const Pose& grip);
    bool send(RunnerCommand command);
    void place(const HandPlacement& placement);
    /// The device's handle is in its home pose now. Waits for a real device's answer, at most a second.
    void home_device(Problems& problems);
    void save_recording(const std::string& path, Problems& problems);
    /// The recording in steps of `interval` (s): HapticRunner::write_samples.
    void save_samples(const std::string& path, double interval, Problems& problems);
    /// The hand takes hold of a linkage elsewhere: `point` in the axes of the link's node, m.
    void grab(std::int64_t link, const Vec2& point, bool pose, Problems& problems);
    /// Of every link of a linkage, in the order of its links: pose of its node (x, y, angle), velocity of its
    /// center of mass (x, y) and angular velocity, coordinate and its rate. Empty for a rigid tool.
    [[nodiscard]] std::vector<double> links() const;
    static constexpr std::size_t k_link_state = 8;
    /// For a linkage: starts it beside `host`, whose loop then steps it; `id` is this world's number. It
    /// stops when `host` does.
    void start_beside(HapticWorld& host, std::int64_t id, Problems& problems);
    /// A body is link `link` of the linkage that runs beside this world as number `linkage`.
    void tie_body(std::int64_t body, std::int64_t linkage, std::int64_t link, Problems& problems);
    /// Center of mass of the tool, or of the link that is held, in the axes of its node, m.
    [[nodiscard]] Vec2 tool_center() const;
    [[nodiscard]] const WorldSettings& settings() const { return settings_; }
    [[nodiscard]] const CouplingGains& gains() const { return gains_; }

  private:
    void begin(bool realtime, double record_seconds, Problems& problems);
    [[nodiscard]] double now() const { return (host_ != nullptr ? host_->runner_ : runner_)->now(); }
    void note_figures(const HapticReport& r);
    void note_overflow(Problems& problems);
    [[nodiscard]] godot::Dictionary neighborhood_figures() const;

    WorldSettings settings_;
    std::optional<ToolModel> tool_;
    Vec2 tool_center_{0.0, 0.0};
    LinkageVector tool_start_;
    /// Rates of the coordinates at the start; empty for a start at rest.
    LinkageVector tool_rates_;
    std::optional<DeviceOptions> device_options_;
    BodyRegistry bodies_;
    std::unique_ptr<WorldDevice> device_;
    std::unique_ptr<HapticRunner> runner_;
    /// The world whose loop steps this one, and those that this one's loop steps.
    HapticWorld* host_{nullptr};
    std::vector<HapticWorld*> guests_;
    HostSteal steal_;
    TickClock ticks_;
    /// Lock-step: length of the last tick (0: none yet), and how far the times of ticks lead the loop's
    /// because they changed their length, s.
    double last_tick_{0.0};
    double tick_lead_{0.0};
    bool realtime_{false};
    CouplingGains gains_;
    HapticReport report_;
    Wrench last_force_{0.0, 0.0, 0.0};
    std::uint64_t sequence_{0};
    std::uint64_t ve_ticks_{0};
    Histogram tick_time_;
    // beliefs of the report whose impulses were handed out last, and of the one before
    HapticReport given_report_;
    std::uint64_t echo_step_{0};
    /// Of the newest snapshot.
    Plan plan_;
    Neighborhood shown_;
    std::uint64_t overflowed_ticks_{0};
    bool said_full_{false};
    bool said_movables_{false};
    std::array<MovableBelief, k_max_movables> echo_;
    std::int32_t echo_count_{0};
    struct Taken {
        std::uint64_t epoch{0};
        Wrench given{0.0, 0.0, 0.0};
    };
    std::map<std::int64_t, Taken> taken_;
    std::map<std::int64_t, bool> complained_;
    std::string scheduling_;
    std::string scheduling_details_;
};

} // namespace haptics
