#pragma once
/// Exports the components of a plug-in library: SCREE_PLUGIN(scree::process<Gravity>("gravity", "1.0.0"), ...).
#include <scree/abi.h>

#if defined(__x86_64__) && defined(__AVX__) && !defined(SCREE_ALLOW_ARCH)
#error \
    "scree: build plug-ins without -march or -mavx: the SDK compiles every law for three instruction sets and picks at run time"
#endif
#if defined(__FAST_MATH__)
#error "scree: build plug-ins without -ffast-math: it changes results and the floating-point mode of the whole program"
#endif

#if defined(__clang__)
#define SCREE_COMPILER "clang " __clang_version__
#else
#define SCREE_COMPILER "gcc " __VERSION__
#endif

/// Names, versions and docs are string literals; the header is constant data that can be read without running any code.
#define SCREE_PLUGIN(...)                                                                                \
  namespace {                                                                                            \
  constinit const scree_component scree_components[] = {__VA_ARGS__};                                    \
  }                                                                                                      \
  extern "C" __attribute__((visibility("default"))) constinit const scree_plugin_header scree_plugin = { \
      SCREE_MAGIC,                                                                                       \
      sizeof(scree_plugin_header),                                                                       \
      SCREE_ABI_MAJOR,                                                                                   \
      SCREE_ABI_MINOR,                                                                                   \
      SCREE_SDK_VERSION,                                                                                 \
      SCREE_COMPILER,                                                                                    \
      sizeof(scree_components) / sizeof(scree_component),                                                \
      sizeof(scree_component),                                                                           \
      scree_components};
