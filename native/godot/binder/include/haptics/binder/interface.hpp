/// The engine's C functions that the binder uses, looked up once when the library is loaded.
#pragma once

#include <gdextension_interface.h>

namespace haptics::godot::internal {

// One line a function: name in the engine's table, type in its header. Only names of Godot 4.6 or older:
// asking for an unknown name prints an engine error, so there is no probing.
#define HAPTICS_BINDER_INTERFACE(X)                                                                          \
    X(get_godot_version2, GDExtensionInterfaceGetGodotVersion2)                                              \
    X(print_error, GDExtensionInterfacePrintError)                                                           \
    X(print_warning, GDExtensionInterfacePrintWarning)                                                       \
    X(variant_new_copy, GDExtensionInterfaceVariantNewCopy)                                                  \
    X(variant_new_nil, GDExtensionInterfaceVariantNewNil)                                                    \
    X(variant_destroy, GDExtensionInterfaceVariantDestroy)                                                   \
    X(variant_call, GDExtensionInterfaceVariantCall)                                                         \
    X(variant_evaluate, GDExtensionInterfaceVariantEvaluate)                                                 \
    X(variant_booleanize, GDExtensionInterfaceVariantBooleanize)                                             \
    X(variant_stringify, GDExtensionInterfaceVariantStringify)                                               \
    X(variant_get_type, GDExtensionInterfaceVariantGetType)                                                  \
    X(variant_has_key, GDExtensionInterfaceVariantHasKey)                                                    \
    X(variant_get_object_instance_id, GDExtensionInterfaceVariantGetObjectInstanceId)                        \
    X(variant_get_type_name, GDExtensionInterfaceVariantGetTypeName)                                         \
    X(variant_can_convert_strict, GDExtensionInterfaceVariantCanConvertStrict)                               \
    X(get_variant_from_type_constructor, GDExtensionInterfaceGetVariantFromTypeConstructor)                  \
    X(get_variant_to_type_constructor, GDExtensionInterfaceGetVariantToTypeConstructor)                      \
    X(variant_get_ptr_operator_evaluator, GDExtensionInterfaceVariantGetPtrOperatorEvaluator)                \
    X(variant_get_ptr_builtin_method, GDExtensionInterfaceVariantGetPtrBuiltinMethod)                        \
    X(variant_get_ptr_constructor, GDExtensionInterfaceVariantGetPtrConstructor)                             \
    X(variant_get_ptr_destructor, GDExtensionInterfaceVariantGetPtrDestructor)                               \
    X(variant_get_ptr_utility_function, GDExtensionInterfaceVariantGetPtrUtilityFunction)                    \
    X(string_new_with_utf8_chars_and_len2, GDExtensionInterfaceStringNewWithUtf8CharsAndLen2)                \
    X(string_to_utf8_chars, GDExtensionInterfaceStringToUtf8Chars)                                           \
    X(string_name_new_with_utf8_chars, GDExtensionInterfaceStringNameNewWithUtf8Chars)                       \
    X(packed_byte_array_operator_index, GDExtensionInterfacePackedByteArrayOperatorIndex)                    \
    X(packed_byte_array_operator_index_const, GDExtensionInterfacePackedByteArrayOperatorIndexConst)         \
    X(packed_int32_array_operator_index, GDExtensionInterfacePackedInt32ArrayOperatorIndex)                  \
    X(packed_int32_array_operator_index_const, GDExtensionInterfacePackedInt32ArrayOperatorIndexConst)       \
    X(packed_int64_array_operator_index, GDExtensionInterfacePackedInt64ArrayOperatorIndex)                  \
    X(packed_int64_array_operator_index_const, GDExtensionInterfacePackedInt64ArrayOperatorIndexConst)       \
    X(packed_float32_array_operator_index, GDExtensionInterfacePackedFloat32ArrayOperatorIndex)              \
    X(packed_float32_array_operator_index_const, GDExtensionInterfacePackedFloat32ArrayOperatorIndexConst)   \
    X(packed_float64_array_operator_index, GDExtensionInterfacePackedFloat64ArrayOperatorIndex)              \
    X(packed_float64_array_operator_index_const, GDExtensionInterfacePackedFloat64ArrayOperatorIndexConst)   \
    X(packed_string_array_operator_index, GDExtensionInterfacePackedStringArrayOperatorIndex)                \
    X(packed_string_array_operator_index_const, GDExtensionInterfacePackedStringArrayOperatorIndexConst)     \
    X(packed_vector2_array_operator_index, GDExtensionInterfacePackedVector2ArrayOperatorIndex)              \
    X(packed_vector2_array_operator_index_const, GDExtensionInterfacePackedVector2ArrayOperatorIndexConst)   \
    X(array_operator_index, GDExtensionInterfaceArrayOperatorIndex)                                          \
    X(array_operator_index_const, GDExtensionInterfaceArrayOperatorIndexConst)                               \
    X(dictionary_operator_index, GDExtensionInterfaceDictionaryOperatorIndex)                                \
    X(dictionary_operator_index_const, GDExtensionInterfaceDictionaryOperatorIndexConst)                     \
    X(object_method_bind_call, GDExtensionInterfaceObjectMethodBindCall)                                     \
    X(object_method_bind_ptrcall, GDExtensionInterfaceObjectMethodBindPtrcall)                               \
    X(object_destroy, GDExtensionInterfaceObjectDestroy)                                                     \
    X(global_get_singleton, GDExtensionInterfaceGlobalGetSingleton)                                          \
    X(object_get_instance_binding, GDExtensionInterfaceObjectGetInstanceBinding)                             \
    X(object_set_instance_binding, GDExtensionInterfaceObjectSetInstanceBinding)                             \
    X(object_set_instance, GDExtensionInterfaceObjectSetInstance)                                            \
    X(object_cast_to, GDExtensionInterfaceObjectCastTo)                                                      \
    X(object_get_instance_from_id, GDExtensionInterfaceObjectGetInstanceFromId)                              \
    X(object_get_instance_id, GDExtensionInterfaceObjectGetInstanceId)                                       \
    X(ref_get_object, GDExtensionInterfaceRefGetObject)                                                      \
    X(ref_set_object, GDExtensionInterfaceRefSetObject)                                                      \
    X(classdb_construct_object2, GDExtensionInterfaceClassdbConstructObject2)                                \
    X(classdb_get_method_bind, GDExtensionInterfaceClassdbGetMethodBind)                                     \
    X(classdb_get_class_tag, GDExtensionInterfaceClassdbGetClassTag)                                         \
    X(classdb_register_extension_class5, GDExtensionInterfaceClassdbRegisterExtensionClass5)                 \
    X(classdb_register_extension_class_method, GDExtensionInterfaceClassdbRegisterExtensionClassMethod)      \
    X(classdb_register_extension_class_integer_constant,                                                     \
      GDExtensionInterfaceClassdbRegisterExtensionClassIntegerConstant)                                      \
    X(classdb_register_extension_class_property, GDExtensionInterfaceClassdbRegisterExtensionClassProperty)  \
    X(classdb_register_extension_class_property_group,                                                       \
      GDExtensionInterfaceClassdbRegisterExtensionClassPropertyGroup)                                        \
    X(classdb_register_extension_class_property_subgroup,                                                    \
      GDExtensionInterfaceClassdbRegisterExtensionClassPropertySubgroup)                                     \
    X(classdb_register_extension_class_signal, GDExtensionInterfaceClassdbRegisterExtensionClassSignal)      \
    X(classdb_unregister_extension_class, GDExtensionInterfaceClassdbUnregisterExtensionClass)               \
    X(get_library_path, GDExtensionInterfaceGetLibraryPath)                                                  \
    X(register_main_loop_callbacks, GDExtensionInterfaceRegisterMainLoopCallbacks)                           \
    X(editor_help_load_xml_from_utf8_chars_and_len, GDExtensionsInterfaceEditorHelpLoadXmlFromUtf8CharsAndLen)

/// The engine's functions under their own names, plus the handle of this library.
struct Interface {
#define HAPTICS_BINDER_MEMBER(name, type) type name = nullptr;
    HAPTICS_BINDER_INTERFACE(HAPTICS_BINDER_MEMBER)
#undef HAPTICS_BINDER_MEMBER
    /// The engine's handle of this library; also the token of its instance bindings.
    GDExtensionClassLibraryPtr library = nullptr;
};

/// Filled before any other code of the library runs; valid until the library goes.
extern Interface api;

/// Looks every function up. False, with a message on stderr, when the engine lacks one (it is older
/// than 4.6).
bool load_interface(GDExtensionInterfaceGetProcAddress get_proc_address, GDExtensionClassLibraryPtr library);

} // namespace haptics::godot::internal
