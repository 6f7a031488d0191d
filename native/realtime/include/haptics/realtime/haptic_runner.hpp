#pragma once
/// Runs a session, on a loop thread or in lock-step, and carries everything between it and the scene without
/// a lock.

#include <haptics/core/control/session.hpp>
#include <haptics/realtime/event_queue.hpp>
#include <haptics/realtime/latest_value.hpp>
#include <haptics/realtime/lockstep_clock.hpp>
#include <haptics/realtime/loop_step.hpp>
#include <haptics/realtime/loop_thread.hpp>
#include <haptics/realtime/step_recorder.hpp>

#include <array>
#include <atomic>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace haptics {

/// What the scene asks of the loop.
enum class RunnerCommand : std::uint8_t { hold, release, arm, disarm, pause, resume, stop };

/// Work that has to happen on the loop thread before each step (a simulated hand takes its target).
class StepHook {
  public:
    StepHook() = default;
    StepHook(const StepHook&) = delete;
    StepHook& operator=(const StepHook&) = delete;
    virtual ~StepHook() = default;
    /// Neither allocates, locks nor throws.
    virtual void before_step(const Session& session) noexcept = 0;
};

/// Owner thread is the scene's main thread; `step` runs on the loop thread while one runs, otherwise on the
/// owner's.
class HapticRunner final : public LoopStep {
  public:
    /// The scene is taken to stall, and forces fade out, when no snapshot came for this long, s.
    static constexpr double k_stall = 1.0;

    /// `hook` may be null and outlives the runner.
    HapticRunner(std::unique_ptr<Session> session, StepHook* hook);
    ~HapticRunner() override;

    /// Owner: starts the thread. False when it could not; thread().report().failure says why.
    bool start(const LoopOptions& options);
    /// Owner: stops and joins; the force is zero afterwards.
    void stop() noexcept;
    /// Owner, no thread running: runs all steps due until `seconds` later. Returns how many. Bit-for-bit
    /// repeatable.
    int advance(double seconds);

    /// Owner: loop-clock time now, s: stamps snapshots.
    [[nodiscard]] double now() const noexcept;

    /// Owner: the snapshot to fill; publish() hands it over.
    [[nodiscard]] Neighborhood& neighborhood() noexcept { return neighborhoods_.slot(); }
    void publish() noexcept { neighborhoods_.publish(); }

    /// Owner: false when the queue is full (nothing reads it).
    bool try_send(RunnerCommand command) noexcept { return commands_.try_push(command); }
    /// Owner: the clutch, mapping and turn wanted from now on.
    void place(const HandPlacement& placement) noexcept { placements_.try_write(placement); }

    /// Owner: the hand takes hold elsewhere (Session::grab). Of several before a step the last counts.
    void grab(const Grip& grip) { grips_.try_write(grip); }

    /// Linkages that nobody holds and that run beside the tool.
    static constexpr int k_max_guests = 8;
    /// Owner: from the next step on, every step of this runner steps `guest` too, which neither has a thread
    /// nor is advanced; `id` > 0 is how bodies name it (Body::linkage). Both have the same step. Of two
    /// guests the one with the smaller id has the other's links among its bodies, and never the other way
    /// round. False when all places are taken.
    bool attach(HapticRunner& guest, std::uint64_t id) noexcept;
    /// Owner: once this returns nothing steps `guest`. Waits at most for the step that runs now.
    void detach(HapticRunner& guest) noexcept;

    /// Owner: the newest report.
    [[nodiscard]] const HapticReport& latest_report() noexcept { return reports_.try_read().value; }
    /// Owner: events since the last call, oldest first.
    template <typename Take>
    void drain_events(Take&& take) {
        events_.drain(std::forward<Take>(take));
    }
    [[nodiscard]] std::uint64_t events_dropped() const noexcept { return events_.dropped(); }

    /// Owner, before start: sets a recorder aside (allocates); the first `seconds` of steps are kept, 0
    /// records nothing.
    void record(double seconds);
    /// Owner: takes over what was recorded since the last call; at least every four seconds while a thread
    /// runs.
    void collect();
    [[nodiscard]] bool recording() const { return recorder_ != nullptr; }
    [[nodiscard]] std::uint64_t rows_dropped() const {
        return recorder_ == nullptr ? 0 : recorder_->dropped();
    }
    /// Owner: writes all rows as CSV. False with the reason in `error`.
    bool write_recording(const std::string& path, std::string& error);
    /// Owner: writes the recording in steps of `interval` (s, a whole number of haptic steps) as CSV: where
    /// the grip then is, the energy that the loop has created, the mean forces since the sample before, and
    /// how many contacts there were at most. False with the reason in `error`.
    bool write_samples(const std::string& path, double interval, std::string& error);

    [[nodiscard]] const LoopThread& thread() const { return thread_; }
    /// Counts of this run, thread or lock-step.
    [[nodiscard]] LoopStatistics statistics() const noexcept;
    /// Only while no thread runs.
    [[nodiscard]] Session& session() { return *session_; }
    [[nodiscard]] const Session& session() const { return *session_; }

    void step(const StepTime& time) override;
    void loop_ends() noexcept override;

  private:
    struct Beside {
        HapticRunner* runner{nullptr};
        std::uint64_t id{0};
    };
    void step_all(const StepTime& time);
    void step_one(const StepTime& time, std::span<const Beside> later);
    void take_scene(const StepTime& time) noexcept;
    void take_commands() noexcept;
    void watch_scene(double time) noexcept;
    void publish_results() noexcept;

    std::unique_ptr<Session> session_;
    StepHook* hook_;
    LatestValue<Neighborhood> neighborhoods_;
    LatestValue<HapticReport> reports_;
    LatestValue<Grip> grips_;
    EventQueue<ContactEvent, 1024> events_;
    EventQueue<RunnerCommand, 64> commands_;
    LatestValue<HandPlacement> placements_;
    struct Guest {
        std::atomic<HapticRunner*> runner{nullptr};
        std::uint64_t id{0}; // written while `runner` is null
    };
    std::array<Guest, k_max_guests> guests_;
    bool is_guest_{false};
    // odd while a step runs
    std::atomic<std::uint64_t> turn_{0};
    std::unique_ptr<StepRecorder> recorder_;
    std::vector<double> rows_;
    std::size_t most_rows_{0};
    LoopThread thread_;
    std::int64_t start_ns_{0};
    // loop side
    double newest_snapshot_{0.0};
    bool seen_snapshot_{false};
    bool paused_by_scene_{false};
    bool stalled_{false};
    // lock-step
    LockstepClock clock_;
    Histogram lockstep_step_time_;
};

} // namespace haptics
