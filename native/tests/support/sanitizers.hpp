#pragma once
/// Says how much of the heap and of the thread calls a sanitizer leaves to the test program.

#if defined(__SANITIZE_ADDRESS__)
#define HAPTICS_TESTS_ASAN 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define HAPTICS_TESTS_ASAN 1
#endif
#endif
#ifndef HAPTICS_TESTS_ASAN
#define HAPTICS_TESTS_ASAN 0
#endif

#if defined(__SANITIZE_THREAD__)
#define HAPTICS_TESTS_TSAN 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define HAPTICS_TESTS_TSAN 1
#endif
#endif
#ifndef HAPTICS_TESTS_TSAN
#define HAPTICS_TESTS_TSAN 0
#endif

/// malloc, pthread and system calls can be replaced: no sanitizer replaces them itself.
#define HAPTICS_TESTS_REPLACE_MALLOC (!HAPTICS_TESTS_ASAN && !HAPTICS_TESTS_TSAN)
/// operator new is replaced on its own: a sanitizer keeps malloc, but clang's ThreadSanitizer keeps operator
/// new too.
#if HAPTICS_TESTS_ASAN || (HAPTICS_TESTS_TSAN && !defined(__clang__))
#define HAPTICS_TESTS_REPLACE_NEW 1
#else
#define HAPTICS_TESTS_REPLACE_NEW 0
#endif
