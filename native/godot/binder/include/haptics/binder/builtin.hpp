/// Owning handles of the engine's built-in value types (String, Dictionary, packed arrays ...).
#pragma once

#include <haptics/binder/interface.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace haptics::godot::internal {

/// What the engine can do with one built-in type; a null member means "not for this type".
struct BuiltinOps {
    GDExtensionPtrConstructor construct_default = nullptr;
    GDExtensionPtrConstructor construct_copy = nullptr;
    GDExtensionPtrDestructor destroy = nullptr;
    GDExtensionPtrOperatorEvaluator equal = nullptr;
    GDExtensionVariantFromTypeConstructorFunc to_variant = nullptr;
    GDExtensionTypeFromVariantConstructorFunc from_variant = nullptr;
    GDExtensionPtrBuiltInMethod size = nullptr;
    GDExtensionPtrBuiltInMethod resize = nullptr;
    GDExtensionPtrBuiltInMethod clear = nullptr;
};

using BuiltinOpsTable = std::array<BuiltinOps, GDEXTENSION_VARIANT_TYPE_VARIANT_MAX>;

/// Indexed by variant type; filled by load_builtin_ops().
extern BuiltinOpsTable builtin_ops;

/// Fills the table for the types that the binder knows.
void load_builtin_ops();

/// Calls a built-in method with typed arguments and an integer result.
inline int64_t call_int(GDExtensionPtrBuiltInMethod method, const void* base, const void* const* args,
                        int32_t count) {
    int64_t result = 0;
    method(const_cast<void*>(base), args, &result, count);
    return result;
}

/// A value of the engine that lives in `Size` opaque bytes. All bytes zero is the moved-from state: it may be
/// destroyed and assigned to, nothing else. Derived classes add no members, so a pointer from the engine can
/// be read as one.
template <GDExtensionVariantType Type, std::size_t Size>
class Builtin {
  public:
    /// The engine's type tag.
    static constexpr GDExtensionVariantType variant_type = Type;

    Builtin() { ops().construct_default(words_, nullptr); }
    Builtin(const Builtin& other) {
        const GDExtensionConstTypePtr args[] = {other.words_};
        ops().construct_copy(words_, args);
    }
    Builtin(Builtin&& other) noexcept { steal(other); }
    Builtin& operator=(const Builtin& other) {
        if (this != &other) {
            Builtin copy(other);
            *this = std::move(copy);
        }
        return *this;
    }
    Builtin& operator=(Builtin&& other) noexcept {
        if (this != &other) {
            destroy();
            steal(other);
        }
        return *this;
    }
    ~Builtin() { destroy(); }

    /// The value as the engine's functions want it.
    void* _native_ptr() { return words_; }
    const void* _native_ptr() const { return words_; }

    bool operator==(const Builtin& other) const {
        GDExtensionBool result = 0;
        ops().equal(words_, other.words_, &result);
        return result != 0;
    }

  protected:
    /// Leaves the bytes zero for a derived constructor to fill.
    struct Uninitialized {};
    explicit Builtin(Uninitialized) {}

    static const BuiltinOps& ops() { return builtin_ops[Type]; }

  private:
    void steal(Builtin& other) {
        for (std::size_t i = 0; i < k_words; ++i) {
            words_[i] = std::exchange(other.words_[i], 0);
        }
    }
    // the engine complains about some types in the moved-from state, and none of them needs destroying then
    void destroy() {
        uint64_t any = 0;
        for (const uint64_t word : words_) {
            any |= word;
        }
        if (any != 0) {
            ops().destroy(words_);
        }
    }

    static constexpr std::size_t k_words = Size / sizeof(uint64_t);
    uint64_t words_[k_words] = {};
};

} // namespace haptics::godot::internal
