/// Everything of the binder.
#pragma once

#include <haptics/binder/array.hpp>
#include <haptics/binder/callable.hpp>
#include <haptics/binder/class_db.hpp>
#include <haptics/binder/dictionary.hpp>
#include <haptics/binder/editor_help.hpp>
#include <haptics/binder/engine.hpp>
#include <haptics/binder/extension_binding.hpp>
#include <haptics/binder/main_loop.hpp>
#include <haptics/binder/object.hpp>
#include <haptics/binder/packed_array.hpp>
#include <haptics/binder/print.hpp>
#include <haptics/binder/ref_counted.hpp>
#include <haptics/binder/string.hpp>
#include <haptics/binder/transform2d.hpp>
#include <haptics/binder/variant.hpp>
#include <haptics/binder/vector2.hpp>
