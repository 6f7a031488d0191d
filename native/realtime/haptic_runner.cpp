#include <haptics/realtime/csv_writer.hpp>
#include <haptics/realtime/haptic_runner.hpp>
#include <haptics/realtime/loop_clock.hpp>
#include <haptics/realtime/run_columns.hpp>

#include <algorithm>
#include <cmath>
#include <thread>

namespace haptics {

HapticRunner::HapticRunner(std::unique_ptr<Session> session, StepHook* hook)
    : session_(std::move(session))
    , hook_(hook)
    , clock_(1.0 / session_->settings().step) {
    // who asks before the first step hears of the start
    reports_.try_write(session_->report());
}

HapticRunner::~HapticRunner() {
    stop();
}

void HapticRunner::record(double seconds) {
    recorder_.reset();
    rows_.clear();
    most_rows_ = static_cast<std::size_t>(std::ceil(std::max(seconds, 0.0) / session_->settings().step));
    if (most_rows_ == 0)
        return;
    constexpr double k_ring = 4.0; // s that the main thread may be late
    const double ring = std::ceil(k_ring / session_->settings().step);
    recorder_ = std::make_unique<StepRecorder>(run_column_names(), static_cast<std::size_t>(ring));
}

void HapticRunner::collect() {
    if (recorder_ == nullptr)
        return;
    recorder_->drain([this](std::span<const double> row) {
        if (rows_.size() < most_rows_ * row.size())
            rows_.insert(rows_.end(), row.begin(), row.end());
    });
}

bool HapticRunner::write_recording(const std::string& path, std::string& error) {
    collect();
    CsvWriter writer;
    const std::span<const double> all(rows_);
    const std::size_t width = run_column_names().size();
    bool good = writer.open(path, run_column_names());
    for (std::size_t i = 0; good && i < all.size(); i += width)
        good = writer.write_row(all.subspan(i, width));
    good = good && writer.finish();
    error = writer.error();
    return good;
}

bool HapticRunner::write_samples(const std::string& path, double interval, std::string& error) {
    collect();
    const double step = session_->settings().step;
    const double ratio = interval / step;
    const auto steps = static_cast<std::size_t>(ratio > 0.0 && ratio < 1e9 ? std::lround(ratio) : 0);
    if (steps == 0 || std::abs(ratio - static_cast<double>(steps)) > 1e-4 * ratio) {
        error = "Samples every " + std::to_string(interval) + " s are no whole number of steps of " +
                std::to_string(step) + " s. Choose a multiple of the step.";
        return false;
    }
    const std::vector<std::string>& names = run_column_names();
    const auto column = [&names](const char* name) {
        return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    };
    const std::array<std::size_t, 4> last{column("proxy_x_m"), column("proxy_y_m"), column("proxy_theta_rad"),
                                          column("energy_injected_j")};
    const std::array<std::size_t, 4> mean{column("force_x_n"), column("force_y_n"),
                                          column("contact_force_x_n"), column("contact_force_y_n")};
    const std::size_t contacts = column("contacts");
    CsvWriter writer;
    bool good = writer.open(path, {"t_s", "x_m", "y_m", "theta_rad", "energy_j", "force_x_n", "force_y_n",
                                   "contact_x_n", "contact_y_n", "contacts"});
    const std::size_t width = names.size();
    for (std::size_t first = 0; good && (first + steps) * width <= rows_.size(); first += steps) {
        const auto at = [&](std::size_t row, std::size_t name) { return rows_[row * width + name]; };
        std::array<double, 10> sample{};
        sample[0] = static_cast<double>(first + steps) * step;
        for (std::size_t i = 0; i < last.size(); ++i)
            sample[1 + i] = at(first + steps - 1, last[i]);
        for (std::size_t row = first; row < first + steps; ++row) {
            for (std::size_t i = 0; i < mean.size(); ++i)
                sample[5 + i] += at(row, mean[i]) / static_cast<double>(steps);
            sample[9] = std::max(sample[9], at(row, contacts));
        }
        good = writer.write_row(sample);
    }
    good = good && writer.finish();
    error = writer.error();
    return good;
}

bool HapticRunner::start(const LoopOptions& options) {
    start_ns_ = loop_clock_ns();
    return thread_.start(*this, options);
}

void HapticRunner::stop() noexcept {
    thread_.stop();
}

double HapticRunner::now() const noexcept {
    if (thread_.running())
        return static_cast<double>(loop_clock_ns() - start_ns_) * 1e-9;
    return static_cast<double>(clock_.scene_ns()) * 1e-9;
}

int HapticRunner::advance(double seconds) {
    const int due = clock_.begin_tick(seconds);
    for (int left = due; left > 0; --left) {
        const std::int64_t begin = loop_clock_ns();
        step(clock_.next());
        lockstep_step_time_.add(loop_clock_ns() - begin);
        if (recorder_ != nullptr && recorder_->recorded() % 1024 == 0)
            collect();
    }
    collect();
    return due;
}

LoopStatistics HapticRunner::statistics() const noexcept {
    LoopStatistics s = thread_.statistics();
    // in lock-step; a thread that is about to make its first step owns the session
    if (s.steps == 0 && !thread_.running()) {
        s.steps = session_->report().step;
        s.step_time = lockstep_step_time_.snapshot();
    }
    return s;
}

void HapticRunner::take_commands() noexcept {
    const auto grip = grips_.try_read();
    if (grip.is_new)
        session_->grab(grip.value);
    commands_.drain([this](RunnerCommand command) {
        switch (command) {
        case RunnerCommand::hold:
            session_->hold(true);
            break;
        case RunnerCommand::release:
            session_->hold(false);
            break;
        case RunnerCommand::arm:
            session_->arm();
            break;
        case RunnerCommand::disarm:
            session_->disarm();
            break;
        case RunnerCommand::pause:
            paused_by_scene_ = true;
            break;
        case RunnerCommand::resume:
            paused_by_scene_ = false;
            break;
        case RunnerCommand::stop:
            session_->raise(Fault::release_the_stop);
            break;
        }
    });
}

void HapticRunner::watch_scene(double time) noexcept {
    stalled_ = seen_snapshot_ && time - newest_snapshot_ > k_stall;
    session_->set_paused(paused_by_scene_ || stalled_);
}

bool HapticRunner::attach(HapticRunner& guest, std::uint64_t id) noexcept {
    for (Guest& g : guests_)
        if (g.runner.load() == nullptr) {
            g.id = id;
            guest.is_guest_ = true;
            g.runner.store(&guest);
            return true;
        }
    return false;
}

// The loop marks its turn before it reads the places, and the place is empty before the turn is read: so
// either the loop sees the empty place, or its step is waited for.
void HapticRunner::detach(HapticRunner& guest) noexcept {
    for (Guest& g : guests_)
        if (g.runner.load() == &guest)
            g.runner.store(nullptr);
    const std::uint64_t turn = turn_.load();
    while (turn % 2 == 1 && turn_.load() == turn && thread_.running())
        std::this_thread::yield();
}

void HapticRunner::take_scene(const StepTime& time) noexcept {
    if (time.skipped > 0)
        session_->skip(static_cast<double>(time.skipped) * time.dt);
    const auto newest = neighborhoods_.try_read();
    if (newest.is_new) {
        session_->take(newest.value);
        newest_snapshot_ = newest.value.time;
        seen_snapshot_ = true;
    }
    const auto placement = placements_.try_read();
    if (placement.is_new)
        session_->place(placement.value);
    take_commands();
    watch_scene(time.time());
}

void HapticRunner::step(const StepTime& time) {
    turn_.fetch_add(1);
    step_all(time);
    turn_.fetch_add(1);
}

// The tool first, then the linkages by their numbers; each meets those that come after it.
void HapticRunner::step_all(const StepTime& time) {
    std::array<Beside, k_max_guests> beside;
    std::size_t count = 0;
    for (Guest& g : guests_)
        if (HapticRunner* guest = g.runner.load()) {
            guest->session_->end_pushes();
            beside[count++] = {guest, g.id};
        }
    const std::span<Beside> guests(beside.data(), count);
    std::sort(guests.begin(), guests.end(), [](const Beside& a, const Beside& b) { return a.id < b.id; });
    step_one(time, guests);
    for (std::size_t i = 0; i < count; ++i)
        guests[i].runner->step_one(time, guests.subspan(i + 1));
}

void HapticRunner::step_one(const StepTime& time, std::span<const Beside> later) {
    take_scene(time);
    if (is_guest_ && paused_by_scene_)
        return;
    if (hook_ != nullptr)
        hook_->before_step(*session_);
    for (const Beside& other : later)
        session_->follow(*other.runner->session_, other.id);
    session_->step();
    for (const Beside& other : later)
        session_->push(*other.runner->session_, other.id);
    publish_results();
}

void HapticRunner::publish_results() noexcept {
    const StepOutput& output = session_->output();
    for (int i = 0; i < output.event_count; ++i)
        events_.try_push(output.event[static_cast<std::size_t>(i)]);
    if (recorder_ != nullptr) {
        std::array<double, k_run_columns> row;
        fill_run_row(session_->report(), row);
        recorder_->try_append(row);
    }
    reports_.try_write(session_->report());
}

void HapticRunner::loop_ends() noexcept {
    session_->shut_off();
}

} // namespace haptics
