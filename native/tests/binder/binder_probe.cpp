#include "binder_probe.hpp"

#include <bit>
#include <numeric>
#include <stdexcept>

namespace haptics {

using namespace godot;

void BinderProbeCounted::_bind_methods() {
    ClassDB::bind_method(D_METHOD("set_label", "label"), &BinderProbeCounted::set_label);
    ClassDB::bind_method(D_METHOD("get_label"), &BinderProbeCounted::get_label);
    ADD_PROPERTY(PropertyInfo(Variant::STRING, "label"), "set_label", "get_label");
}

Ref<BinderProbeCounted> BinderProbe::make_counted() const {
    Ref<BinderProbeCounted> ref;
    ref.instantiate();
    ref->set_label("made in C++");
    return ref;
}

int64_t BinderProbe::throw_exception(const String& message) const {
    throw std::runtime_error(message.utf8());
}

Dictionary BinderProbe::throw_something() const {
    throw 3;
}

double BinderProbe::sum(const PackedFloat64Array& values) const {
    const std::span<const double> all = values.span();
    return std::accumulate(all.begin(), all.end(), 0.0);
}

int64_t BinderProbe::address(const PackedFloat64Array& values) const {
    return std::bit_cast<int64_t>(values.ptr());
}

PackedVector2Array BinderProbe::ramp(int64_t count) const {
    PackedVector2Array result;
    result.resize(count);
    real_t x = 0;
    for (Vector2& point : result.span_w()) {
        point = Vector2(x, -x);
        x += 1;
    }
    return result;
}

Dictionary BinderProbe::describe() const {
    Dictionary result;
    result["name"] = "probe";
    result["gain"] = gain_;
    result["forces"] = PackedFloat64Array{1.0, 2.5};
    result.set("list", Array::make(1, "two", Vector2(3, 3)));
    const double read = result["gain"];
    result["same"] = read == gain_ && result.has("name") && !result.has("nothing") &&
                     result["name"] == "probe" && result["nothing"].get_type() == Variant::NIL &&
                     result.keys().size() == result.size();
    return result;
}

Variant BinderProbe::call_back(const Callable& callable, const Variant& argument) const {
    return callable.call(argument, 1);
}

String BinderProbe::class_name_of(Object* object) const {
    return object == nullptr ? String("null") : object->get_class();
}

// What C++ makes of a value: as integer, real, text and truth.
Array BinderProbe::read_back(const Variant& value) const {
    const int64_t number = value;
    const double real = value;
    const String text = value;
    return Array::make(number, real, text, value.booleanize(), value.stringify(), value == Variant(number));
}

void BinderProbe::_bind_methods() {
    ClassDB::bind_method(D_METHOD("echo_bool", "value"), &BinderProbe::echo<bool>);
    ClassDB::bind_method(D_METHOD("echo_int", "value"), &BinderProbe::echo<int64_t>);
    ClassDB::bind_method(D_METHOD("echo_int32", "value"), &BinderProbe::echo_by_value<int32_t>);
    ClassDB::bind_method(D_METHOD("echo_float", "value"), &BinderProbe::echo_by_value<double>);
    ClassDB::bind_method(D_METHOD("echo_float32", "value"), &BinderProbe::echo<float>);
    ClassDB::bind_method(D_METHOD("echo_string", "value"), &BinderProbe::echo<String>);
    ClassDB::bind_method(D_METHOD("echo_string_by_value", "value"), &BinderProbe::echo_by_value<String>);
    ClassDB::bind_method(D_METHOD("echo_string_name", "value"), &BinderProbe::echo<StringName>);
    ClassDB::bind_method(D_METHOD("echo_vector2", "value"), &BinderProbe::echo_by_value<Vector2>);
    ClassDB::bind_method(D_METHOD("echo_transform2d", "value"), &BinderProbe::echo<Transform2D>);
    ClassDB::bind_method(D_METHOD("echo_dictionary", "value"), &BinderProbe::echo<Dictionary>);
    ClassDB::bind_method(D_METHOD("echo_array", "value"), &BinderProbe::echo<Array>);
    ClassDB::bind_method(D_METHOD("echo_bytes", "value"), &BinderProbe::echo<PackedByteArray>);
    ClassDB::bind_method(D_METHOD("echo_int32s", "value"), &BinderProbe::echo<PackedInt32Array>);
    ClassDB::bind_method(D_METHOD("echo_int64s", "value"), &BinderProbe::echo<PackedInt64Array>);
    ClassDB::bind_method(D_METHOD("echo_float32s", "value"), &BinderProbe::echo<PackedFloat32Array>);
    ClassDB::bind_method(D_METHOD("echo_float64s", "value"), &BinderProbe::echo_by_value<PackedFloat64Array>);
    ClassDB::bind_method(D_METHOD("echo_strings", "value"), &BinderProbe::echo<PackedStringArray>);
    ClassDB::bind_method(D_METHOD("echo_vectors", "value"), &BinderProbe::echo<PackedVector2Array>);
    ClassDB::bind_method(D_METHOD("echo_variant", "value"), &BinderProbe::echo<Variant>);
    ClassDB::bind_method(D_METHOD("echo_callable", "value"), &BinderProbe::echo<Callable>);
    ClassDB::bind_method(D_METHOD("echo_axis", "value"), &BinderProbe::echo_by_value<Axis>);
    ClassDB::bind_method(D_METHOD("echo_object", "value"), &BinderProbe::echo_object);
    ClassDB::bind_method(D_METHOD("echo_probe", "value"), &BinderProbe::echo_probe);
    ClassDB::bind_method(D_METHOD("echo_ref", "value"), &BinderProbe::echo_ref);
    ClassDB::bind_method(D_METHOD("echo_any_ref", "value"), &BinderProbe::echo_any_ref);

    ClassDB::bind_method(D_METHOD("make_counted"), &BinderProbe::make_counted);
    ClassDB::bind_method(D_METHOD("keep", "ref"), &BinderProbe::keep);
    ClassDB::bind_method(D_METHOD("kept_references"), &BinderProbe::kept_references);

    ClassDB::bind_method(D_METHOD("nothing"), &BinderProbe::nothing);
    ClassDB::bind_method(D_METHOD("get_calls"), &BinderProbe::get_calls);
    ClassDB::bind_method(D_METHOD("get_post_initialized"), &BinderProbe::get_post_initialized);
    ClassDB::bind_method(D_METHOD("get_reloaded"), &BinderProbe::get_reloaded);
    ClassDB::bind_static_method("BinderProbe", D_METHOD("add", "a", "b"), &BinderProbe::add);
    ClassDB::bind_method(D_METHOD("defaults", "a", "b", "c"), &BinderProbe::defaults, DEFVAL(2.0),
                         DEFVAL("abc"));
    ClassDB::bind_static_method("BinderProbe", D_METHOD("count_alive"), &BinderProbe::count_alive);
    ClassDB::bind_static_method("BinderProbe", D_METHOD("count_counted_alive"),
                                &BinderProbe::count_counted_alive);

    ClassDB::bind_method(D_METHOD("throw_exception", "message"), &BinderProbe::throw_exception);
    ClassDB::bind_method(D_METHOD("throw_something"), &BinderProbe::throw_something);
    ClassDB::bind_method(D_METHOD("complain", "message"), &BinderProbe::complain);
    ClassDB::bind_method(D_METHOD("warn", "message"), &BinderProbe::warn);
    ClassDB::bind_method(D_METHOD("say", "a", "b"), &BinderProbe::say);

    ClassDB::bind_method(D_METHOD("sum", "values"), &BinderProbe::sum);
    ClassDB::bind_method(D_METHOD("address", "values"), &BinderProbe::address);
    ClassDB::bind_method(D_METHOD("ramp", "count"), &BinderProbe::ramp);
    ClassDB::bind_method(D_METHOD("describe"), &BinderProbe::describe);
    ClassDB::bind_method(D_METHOD("call_back", "callable", "argument"), &BinderProbe::call_back);
    ClassDB::bind_method(D_METHOD("own_callable"), &BinderProbe::own_callable);
    ClassDB::bind_method(D_METHOD("class_name_of", "object"), &BinderProbe::class_name_of);
    ClassDB::bind_method(D_METHOD("read_back", "value"), &BinderProbe::read_back);

    ClassDB::bind_method(D_METHOD("set_gain", "gain"), &BinderProbe::set_gain);
    ClassDB::bind_method(D_METHOD("get_gain"), &BinderProbe::get_gain);
    ClassDB::bind_method(D_METHOD("set_mode", "mode"), &BinderProbe::set_mode);
    ClassDB::bind_method(D_METHOD("get_mode"), &BinderProbe::get_mode);
    ClassDB::bind_method(D_METHOD("fire", "number", "where"), &BinderProbe::fire);

    ADD_GROUP("Contact", "");
    ADD_PROPERTY(PropertyInfo(Variant::FLOAT, "gain", PROPERTY_HINT_RANGE, "0,100,0.5,suffix:N"), "set_gain",
                 "get_gain");
    ADD_PROPERTY(PropertyInfo(Variant::INT, "mode", PROPERTY_HINT_ENUM, "Idle:0,Busy:7"), "set_mode",
                 "get_mode");
    ADD_SIGNAL(
        MethodInfo("fired", PropertyInfo(Variant::INT, "number"), PropertyInfo(Variant::VECTOR2, "where")));
    BIND_ENUM_CONSTANT(MODE_IDLE);
    BIND_ENUM_CONSTANT(MODE_BUSY);
    BIND_ENUM_CONSTANT(Axis::X);
    BIND_ENUM_CONSTANT(Axis::Y);
    ClassDB::bind_integer_constant(get_class_static(), "", "ANSWER", k_answer);
}

} // namespace haptics
