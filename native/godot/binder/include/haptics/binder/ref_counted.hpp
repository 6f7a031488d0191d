/// Reference counted objects.
#pragma once

#include <haptics/binder/object.hpp>

#include <utility>

namespace haptics::godot {

/// Base of bound classes that live as long as someone holds a Ref to them.
class RefCounted : public Object {
  public:
    static const StringName& get_class_static() { return SNAME("RefCounted"); }
    static const StringName& engine_class_static() { return get_class_static(); }

    /// Takes the first reference (or one more); false when the object is being destroyed.
    bool init_ref();
    bool reference();
    /// True when it was the last one: the caller destroys the object then.
    bool unreference();
    int32_t get_reference_count() const;
};

namespace internal {

template <class T>
T* make_instance();

} // namespace internal

/// A counted pointer to a T; null by default.
template <class T>
class Ref {
  public:
    Ref() = default;
    Ref(std::nullptr_t) {}
    Ref(T* object) {
        if (object != nullptr && object->init_ref()) {
            object_ = object;
        }
    }
    Ref(const Ref& other)
        : Ref(other.object_) {}
    Ref(Ref&& other) noexcept
        : object_(std::exchange(other.object_, nullptr)) {}
    Ref& operator=(Ref other) noexcept {
        std::swap(object_, other.object_);
        return *this;
    }
    ~Ref() { unref(); }

    /// Makes a new object, as memnew does, and holds it.
    void instantiate() { *this = Ref(internal::make_instance<T>()); }
    void unref() {
        if (object_ != nullptr && object_->unreference()) {
            internal::destroy_object(object_);
        }
        object_ = nullptr;
    }

    T* ptr() const { return object_; }
    T* operator->() const { return object_; }
    T& operator*() const { return *object_; }
    bool is_valid() const { return object_ != nullptr; }
    bool is_null() const { return object_ == nullptr; }
    bool operator==(const Ref&) const = default;

  private:
    T* object_ = nullptr;
};

template <class T>
struct TypeBinding<Ref<T>> {
    using Class = T;
    static constexpr GDExtensionVariantType variant_type = GDEXTENSION_VARIANT_TYPE_OBJECT;
    static constexpr GDExtensionClassMethodArgumentMetadata metadata =
        GDEXTENSION_METHOD_ARGUMENT_METADATA_NONE;

    static Ref<T> from_ptr(const void* from) {
        return Ref<T>(from == nullptr ? nullptr
                                      : TypeBinding<T*>::from_engine(internal::api.ref_get_object(from)));
    }
    static void to_ptr(void* to, const Ref<T>& value) {
        internal::api.ref_set_object(to, value.is_null() ? nullptr : value->_owner);
    }
    static Ref<T> from_variant(const Variant& from) { return Ref<T>(TypeBinding<T*>::from_variant(from)); }
    static void to_variant(void* uninitialized, const Ref<T>& value) {
        TypeBinding<T*>::to_variant(uninitialized, value.ptr());
    }
};

} // namespace haptics::godot
