#pragma once

#include <haptics/binder/godot.hpp>

namespace haptics {

/// Reference counted test class; counts its own instances.
class BinderProbeCounted : public godot::RefCounted {
    GDCLASS(BinderProbeCounted, godot::RefCounted)

  public:
    BinderProbeCounted() { ++alive; }
    ~BinderProbeCounted() override { --alive; }

    void set_label(const godot::String& label) { label_ = label; }
    godot::String get_label() const { return label_; }

    static inline int64_t alive = 0;

  protected:
    static void _bind_methods();

  private:
    godot::String label_;
};

/// Plain test class: sends every type there and back, and misbehaves on request.
class BinderProbe : public godot::Object {
    GDCLASS(BinderProbe, godot::Object)

  public:
    enum Mode { MODE_IDLE = 0, MODE_BUSY = 7 };
    enum class Axis : uint8_t { X, Y };
    static constexpr int64_t k_answer = 42;

    BinderProbe() { ++alive; }
    ~BinderProbe() override { --alive; }

    void _notification(int what) {
        post_initialized_ += what == NOTIFICATION_POSTINITIALIZE ? 1 : 0;
        reloaded_ += what == NOTIFICATION_EXTENSION_RELOADED ? 1 : 0;
    }
    godot::String _to_string() const { return "<probe>"; }

    template <class T>
    T echo(const T& value) {
        return value;
    }
    template <class T>
    T echo_by_value(T value) const {
        return value;
    }
    godot::Object* echo_object(godot::Object* object) { return object; }
    BinderProbe* echo_probe(BinderProbe* probe) { return probe; }
    godot::Ref<BinderProbeCounted> echo_ref(const godot::Ref<BinderProbeCounted>& ref) { return ref; }
    godot::Ref<godot::RefCounted> echo_any_ref(const godot::Ref<godot::RefCounted>& ref) { return ref; }

    godot::Ref<BinderProbeCounted> make_counted() const;
    void keep(const godot::Ref<BinderProbeCounted>& ref) { kept_ = ref; }
    int32_t kept_references() const { return kept_.is_null() ? 0 : kept_->get_reference_count(); }

    void nothing() { ++calls_; }
    int64_t get_calls() const { return calls_; }
    int64_t get_post_initialized() const { return post_initialized_; }
    int64_t get_reloaded() const { return reloaded_; }
    static int64_t add(int64_t a, int64_t b) { return a + b; }
    int64_t defaults(int64_t a, double b, const godot::String& c) const {
        return a * 100 + static_cast<int64_t>(b) * 10 + c.length();
    }
    static int64_t count_alive() { return alive; }
    static int64_t count_counted_alive() { return BinderProbeCounted::alive; }

    int64_t throw_exception(const godot::String& message) const;
    godot::Dictionary throw_something() const;
    void complain(const godot::String& message) const { godot::print_error(message.utf8()); }
    void warn(const godot::String& message) const { godot::print_warning(message.utf8()); }
    void say(const godot::Variant& a, const godot::Variant& b) const { godot::print_line(a, b); }

    double sum(const godot::PackedFloat64Array& values) const;
    /// The address of the first value, to show that reading makes no copy.
    int64_t address(const godot::PackedFloat64Array& values) const;
    godot::PackedVector2Array ramp(int64_t count) const;
    godot::Dictionary describe() const;
    godot::Variant call_back(const godot::Callable& callable, const godot::Variant& argument) const;
    godot::Callable own_callable() const { return godot::Callable(this, "add"); }
    godot::String class_name_of(godot::Object* object) const;
    godot::Array read_back(const godot::Variant& value) const;

    void set_gain(double gain) { gain_ = gain; }
    double get_gain() const { return gain_; }
    void set_mode(Mode mode) { mode_ = mode; }
    Mode get_mode() const { return mode_; }
    void fire(int64_t number, const godot::Vector2& where) { emit_signal(SNAME("fired"), number, where); }

    static inline int64_t alive = 0;

  protected:
    static void _bind_methods();

  private:
    int64_t calls_ = 0;
    int64_t post_initialized_ = 0;
    int64_t reloaded_ = 0;
    double gain_ = 1.5;
    Mode mode_ = MODE_IDLE;
    godot::Ref<BinderProbeCounted> kept_;
};

} // namespace haptics

VARIANT_ENUM_CAST(haptics::BinderProbe::Mode)
VARIANT_ENUM_CAST(haptics::BinderProbe::Axis)
