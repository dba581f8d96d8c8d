// One small contact model that is right unless a macro makes one thing wrong; tests/loader/CMakeLists.txt lists them.
#include <scree/abi.h>
#include <stdlib.h>

#define EXPORT __attribute__((visibility("default")))

#ifndef MAGIC
#define MAGIC SCREE_MAGIC
#endif
#ifndef MAJOR
#define MAJOR SCREE_ABI_MAJOR
#endif
#ifndef MINOR
#define MINOR SCREE_ABI_MINOR
#endif
#ifndef HEADER_SIZE
#define HEADER_SIZE sizeof(scree_plugin_header)
#endif
#ifndef KIND
#define KIND SCREE_CONTACT_MODEL
#endif
#ifndef NAME
#define NAME "spring"
#endif
#ifndef COUNT
#define COUNT 1
#endif
#ifndef WORD
#define WORD 0
#endif
#ifndef PROPERTY
#define PROPERTY "kn"
#endif
#ifndef FALLBACK
#define FALLBACK 1
#endif
#ifndef STIFFNESS
#define STIFFNESS stiffness
#endif
#ifndef TABLE_SIZE
#define TABLE_SIZE sizeof(scree_contact_model)
#endif
#ifndef PROPERTY_SIZE
#define PROPERTY_SIZE sizeof(scree_property)
#endif
#ifndef FORM
#define FORM "kn"
#endif

#ifdef EXTRA_EXPORT
EXPORT int helper(void) { return 1; }
#endif
#ifdef NEEDS_SYMBOL
int scree_test_function_that_does_not_exist(void);
#endif
#ifdef START_CODE
__attribute__((constructor)) static void start(void) { setenv("SCREE_TEST_STARTED", "yes", 1); }
#endif
#ifdef FAST_MATH
#include <xmmintrin.h>
__attribute__((constructor)) static void start(void) { _mm_setcsr(_mm_getcsr() | 0x8040); }
#endif

static uint32_t law(const void* rule, const scree_batch* b) {
  const double kn = *(const double*)rule;
  for (uint32_t i = 0; i < b->n; ++i) b->fx[i] = -kn * b->gap[i];
#ifdef NEEDS_SYMBOL
  return (uint32_t)scree_test_function_that_does_not_exist();
#else
  return 0;
#endif
}
__attribute__((unused)) static void stiffness(const void* rule, const scree_batch* b, const scree_stiffness* out) {
  for (uint32_t i = 0; i < b->n; ++i) out->normal[i] = *(const double*)rule;
}

static const scree_property properties[] = {
    {PROPERTY_SIZE, SCREE_NUMBER, PROPERTY, "N/m", "stiffness", WORD, 1, SCREE_HAS_LOW | SCREE_HAS_FALLBACK, 0,
     0, 0, FALLBACK, 0, 0, 0, 0},
};
static const char* const forms[] = {FORM};
static const scree_contact_model model = {
    .struct_size = TABLE_SIZE,
    .property_count = 1,
    .properties = properties,
    .rule_words = 1,
    .form_count = 1,
    .forms = forms,
    .uniform = {law},
    .varying = {law},
    .stiffness = STIFFNESS,
};
static const void* table(void) {
#ifdef NO_TABLE
  return 0;
#else
  return &model;
#endif
}

static const scree_component components[] = {
    {KIND, 0, NAME, "1.0.0", "a spring", table},
    {KIND, 0, NAME, "1.0.0", "the same again", table},
};
#ifndef NO_SYMBOL
EXPORT const scree_plugin_header scree_plugin = {
    MAGIC, HEADER_SIZE, MAJOR, MINOR, SCREE_SDK_VERSION, "C", COUNT, sizeof(scree_component), components,
};
#endif
