/// One bound method: what the engine is told of it, and the two ways in which the engine calls it.
#pragma once

#include <haptics/binder/property_info.hpp>
#include <haptics/binder/ref_counted.hpp>

#include <exception>
#include <memory>
#include <utility>

namespace haptics::godot {

/// A method's name with the names of its arguments; made by D_METHOD.
struct MethodDefinition {
    StringName name;
    std::vector<StringName> arguments;
};

/// D_METHOD("name", "first argument", ...)
template <class... Args>
MethodDefinition D_METHOD(const char* name, const Args&... arguments) {
    return {StringName(name), {StringName(arguments)...}};
}

/// The default of a trailing argument.
#define DEFVAL(m_value) (m_value)

namespace internal {

/// "haptics::Probe::Mode" as scripts write it: "Probe.Mode"; "" stays "".
StringName enum_class_name(const char* cpp_name);

/// What the engine is told about a T as argument or return value.
template <class T>
PropertyInfo property_info_of() {
    PropertyInfo info;
    info.type = static_cast<Variant::Type>(TypeBinding<T>::variant_type);
    if constexpr (std::same_as<T, Variant>) {
        info.usage |= PROPERTY_USAGE_NIL_IS_VARIANT;
    } else if constexpr (requires { typename TypeBinding<T>::Class; }) {
        info.class_name = TypeBinding<T>::Class::get_class_static();
    } else if constexpr (std::is_enum_v<T>) {
        info.class_name = enum_class_name(EnumName<T>::value);
        if (!info.class_name.is_empty()) {
            info.usage |= PROPERTY_USAGE_CLASS_IS_ENUM;
        }
    }
    return info;
}

/// What is common to all bound methods; owned by the ClassDB until the library goes.
struct MethodBind {
    StringName class_name;
    StringName name;
    uint32_t flags = GDEXTENSION_METHOD_FLAGS_DEFAULT;
    std::vector<PropertyInfo> arguments;
    std::vector<GDExtensionClassMethodArgumentMetadata> argument_metadata;
    bool has_return = false;
    PropertyInfo return_value;
    GDExtensionClassMethodArgumentMetadata return_metadata = GDEXTENSION_METHOD_ARGUMENT_METADATA_NONE;
    std::vector<Variant> defaults; ///< Of the last arguments, in order.
    GDExtensionClassMethodCall call = nullptr;
    GDExtensionClassMethodPtrCall ptrcall = nullptr;

    virtual ~MethodBind() = default;

    /// Fills `all` (as long as the arguments) from the caller's and the defaults; false with `error` set when
    /// the count or a type is wrong.
    bool gather(const GDExtensionConstVariantPtr* given, int64_t count, const Variant** all,
                GDExtensionCallError* error) const;
    /// Prints an engine error that names the method.
    void report(const char* what) const;
};

/// Is the object in `value` (or null) a T? Asked after the variant type has been found right.
template <class T>
bool is_right_class(const Variant& value) {
    if constexpr (requires { typename TypeBinding<T>::Class; }) {
        const GDExtensionObjectPtr object = live_object(value);
        return object == nullptr ||
               TypeBinding<typename TypeBinding<T>::Class*>::from_engine(object) != nullptr;
    } else {
        return true;
    }
}

/// The thunks of one method signature. `Class` is void for a static method.
template <class Function, class Class, class Return, class... Params>
struct TypedMethodBind final : MethodBind {
    using Result = std::remove_cvref_t<Return>;
    static constexpr std::size_t k_count = sizeof...(Params);
    static constexpr auto k_indices = std::index_sequence_for<Params...>();
    static_assert(
        ((!std::is_lvalue_reference_v<Params> || std::is_const_v<std::remove_reference_t<Params>>) && ...),
        "A bound method takes its arguments by value or by const reference.");

    Function function;

    explicit TypedMethodBind(Function function_value)
        : function(function_value) {
        arguments = {property_info_of<std::remove_cvref_t<Params>>()...};
        argument_metadata = {TypeBinding<std::remove_cvref_t<Params>>::metadata...};
        if constexpr (!std::is_void_v<Return>) {
            has_return = true;
            return_value = property_info_of<Result>();
            return_metadata = TypeBinding<Result>::metadata;
        }
        call = &on_call;
        ptrcall = &on_ptrcall;
    }

    template <class... Args>
    Return invoke(void* instance, Args&&... args) const {
        if constexpr (std::is_void_v<Class>) {
            return function(std::forward<Args>(args)...);
        } else {
            return (static_cast<Class*>(static_cast<Wrapped*>(instance))->*function)(
                std::forward<Args>(args)...);
        }
    }

    template <std::size_t... I>
    Return invoke_ptr(void* instance, [[maybe_unused]] const GDExtensionConstTypePtr* args,
                      std::index_sequence<I...>) const {
        return invoke(instance, TypeBinding<std::remove_cvref_t<Params>>::from_ptr(args[I])...);
    }

    template <std::size_t... I>
    Return invoke_variant(void* instance, [[maybe_unused]] const Variant* const* args,
                          std::index_sequence<I...>) const {
        return invoke(instance, TypeBinding<std::remove_cvref_t<Params>>::from_variant(*args[I])...);
    }

    template <std::size_t... I>
    static int first_wrong_class([[maybe_unused]] const Variant* const* args, std::index_sequence<I...>) {
        int wrong = -1;
        ((wrong < 0 && !is_right_class<std::remove_cvref_t<Params>>(*args[I]) ? wrong = static_cast<int>(I)
                                                                              : 0),
         ...);
        return wrong;
    }

    /// Runs `body`, turning a C++ exception into an engine error. True when it returned.
    template <class Body>
    bool guarded(Body&& body) const {
        try {
            body();
            return true;
        } catch (const std::exception& exception) {
            report(exception.what());
        } catch (...) {
            report("unknown C++ exception");
        }
        return false;
    }

    static void on_call(void* userdata, GDExtensionClassInstancePtr instance,
                        const GDExtensionConstVariantPtr* args, GDExtensionInt count,
                        GDExtensionVariantPtr result, GDExtensionCallError* error) {
        const auto& bind = *static_cast<const TypedMethodBind*>(static_cast<const MethodBind*>(userdata));
        if (!std::is_void_v<Class> && instance == nullptr) {
            error->error = GDEXTENSION_CALL_ERROR_INSTANCE_IS_NULL;
            return;
        }
        const Variant* all[k_count + 1] = {};
        if (!bind.gather(args, count, all, error)) {
            return;
        }
        if (const int wrong = first_wrong_class(all, k_indices); wrong >= 0) {
            *error = {GDEXTENSION_CALL_ERROR_INVALID_ARGUMENT, wrong, GDEXTENSION_VARIANT_TYPE_OBJECT};
            return;
        }
        error->error = GDEXTENSION_CALL_OK;
        bind.guarded([&] {
            if constexpr (std::is_void_v<Return>) {
                bind.invoke_variant(instance, all, k_indices);
            } else {
                *static_cast<Variant*>(result) = Variant(bind.invoke_variant(instance, all, k_indices));
            }
        });
    }

    // The slot is written on every way out: the engine hands over uninitialized scalars.
    static void on_ptrcall(void* userdata, GDExtensionClassInstancePtr instance,
                           const GDExtensionConstTypePtr* args, GDExtensionTypePtr result) {
        const auto& bind = *static_cast<const TypedMethodBind*>(static_cast<const MethodBind*>(userdata));
        const bool done = bind.guarded([&] {
            if constexpr (std::is_void_v<Return>) {
                bind.invoke_ptr(instance, args, k_indices);
            } else {
                TypeBinding<Result>::to_ptr(result, bind.invoke_ptr(instance, args, k_indices));
            }
        });
        if constexpr (!std::is_void_v<Return>) {
            if (!done) {
                TypeBinding<Result>::to_ptr(result, Result{});
            }
        }
    }
};

template <class Class, class Return, class... Params>
std::unique_ptr<MethodBind> create_method_bind(Return (Class::*function)(Params...)) {
    return std::make_unique<TypedMethodBind<decltype(function), Class, Return, Params...>>(function);
}

template <class Class, class Return, class... Params>
std::unique_ptr<MethodBind> create_method_bind(Return (Class::*function)(Params...) const) {
    auto bind =
        std::make_unique<TypedMethodBind<decltype(function), const Class, Return, Params...>>(function);
    bind->flags |= GDEXTENSION_METHOD_FLAG_CONST;
    return bind;
}

template <class Return, class... Params>
std::unique_ptr<MethodBind> create_method_bind(Return (*function)(Params...)) {
    auto bind = std::make_unique<TypedMethodBind<decltype(function), void, Return, Params...>>(function);
    bind->flags |= GDEXTENSION_METHOD_FLAG_STATIC;
    return bind;
}

} // namespace internal

} // namespace haptics::godot
