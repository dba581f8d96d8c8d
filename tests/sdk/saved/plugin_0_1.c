// One library with a component of every kind, as somebody built it against the header of ABI 0.1 (abi_0_1.h, saved and
// never changed). It must go on running in every later 0.x.
#include "abi_0_1.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define NUMBER(name, unit, word, flags, fallback) \
  { sizeof(scree_property), SCREE_NUMBER, name, unit, "of old", word, 1, flags, 0, 0, 0, fallback, 0, 0, 0, 0 }

static int refuse(const scree_refusal* refusal, const char* why) {
  if (refusal != 0 && refusal->size > strlen(why)) strcpy(refusal->why, why);
  return 1;
}

// A spring whose contacts remember their deepest overlap, with two properties.
static uint32_t law(const void* rule, const scree_batch* b) {
  const double kn = ((const double*)rule)[0], pull = ((const double*)rule)[1];
  for (uint32_t i = 0; i < b->n; ++i) {
    const double f = (b->gap[i] < 0 ? -kn * b->gap[i] : 0) - pull;
    b->fx[i] = f * b->nx[i], b->fy[i] = f * b->ny[i], b->fz[i] = f * b->nz[i];
    if (-b->gap[i] > b->state[0][i]) b->state[0][i] = -b->gap[i];
    if (b->sliding != 0) b->sliding[i] = 0;
  }
  return 0;
}
static uint32_t law_varying(const void* rule, const scree_batch* b) {
  (void)rule;
  for (uint32_t i = 0; i < b->n; ++i) {
    const double f = (b->gap[i] < 0 ? -b->property[0][i] * b->gap[i] : 0) - b->property[1][i];
    b->fx[i] = f * b->nx[i], b->fy[i] = f * b->ny[i], b->fz[i] = f * b->nz[i];
  }
  return 0;
}
static void stiffness(const void* rule, const scree_batch* b, const scree_stiffness* out) {
  for (uint32_t i = 0; i < b->n; ++i) out->normal[i] = b->property ? b->property[0][i] : ((const double*)rule)[0];
}
static const scree_property springs[] = {
    NUMBER("kn", "N/m", 0, SCREE_REQUIRED | SCREE_HAS_LOW, 0),
    NUMBER("pull", "N", 1, SCREE_HAS_FALLBACK, 0),
};
static const scree_state_word memory[] = {{"deepest", "m", 0, 1}};
static const scree_contact_model model = {.struct_size = sizeof model,
                                          .property_count = 2,
                                          .state_count = 1,
                                          .properties = springs,
                                          .states = memory,
                                          .rule_words = 2,
                                          .state_words = 1,
                                          .uniform = {law},
                                          .varying = {law_varying},
                                          .stiffness = stiffness};

// The object of wall, process and writer: up to four numbers.
typedef struct numbers {
  double value[4];
  char name[100];
} numbers;
static void* create(void) { return calloc(1, sizeof(numbers)); }
static int set(void* self, uint32_t property, const scree_value* value, const scree_refusal* refusal) {
  if (property >= 4 || value->numbers == 0) return refuse(refusal, "there is no such setting");
  ((numbers*)self)->value[property] = value->numbers[0];
  return 0;
}

static const scree_property heights[] = {NUMBER("slope", "1", 0, SCREE_HAS_FALLBACK, 0),
                                         NUMBER("height", "m", 0, SCREE_REQUIRED, 0)};
static uint32_t touch(const void* self, uint32_t n, const double* x, const double* y, const double* z,
                      const double* reach, const scree_touches* out) {
  uint32_t count = 0;
  (void)x, (void)y;
  for (uint32_t i = 0; i < n; ++i) {
    const double distance = z[i] - ((const numbers*)self)->value[1];
    if (distance >= reach[i]) continue;
    if (count < out->capacity) {
      out->ball[count] = i, out->patch[count] = 0, out->distance[count] = distance;
      out->nx[count] = 0, out->ny[count] = 0, out->nz[count] = -1;
    }
    ++count;
  }
  return count;
}
static const scree_wall wall = {.struct_size = sizeof wall,
                                .flags = SCREE_WALL_FLAT,
                                .object = {sizeof(scree_object), 2, heights, create, free, set, 0},
                                .touch = touch};

// A generator that takes a table: rows of x and radius.
typedef struct table {
  uint32_t rows;
  double cell[2 * 16];
} table;
static void* create_table(void) { return calloc(1, sizeof(table)); }
static int set_table(void* self, uint32_t property, const scree_value* value, const scree_refusal* refusal) {
  table* t = self;
  if (property != 0 || value->columns != 2 || value->rows > 16) return refuse(refusal, "at most 16 rows of two");
  t->rows = value->rows;
  memcpy(t->cell, value->numbers, 2 * sizeof(double) * value->rows);
  return 0;
}
static int generate(const void* self, const scree_sink* sink, const scree_refusal* refusal) {
  const table* t = self;
  for (uint32_t k = 0; k < t->rows; ++k) {
    scree_ball ball = {.struct_size = sizeof ball, .position = {t->cell[2 * k], 0, t->cell[2 * k + 1]}};
    ball.radius = t->cell[2 * k + 1];
    if (sink->ball(sink->self, &ball) == 0) return refuse(refusal, "stopped");
  }
  return 0;
}
static const scree_property columns[] = {NUMBER("x", "m", 0, SCREE_REQUIRED, 0),
                                         NUMBER("radius", "m", 1, SCREE_REQUIRED, 0)};
static const scree_property places[] = {{.struct_size = sizeof(scree_property),
                                         .type = SCREE_TABLE,
                                         .name = "places",
                                         .unit = "1",
                                         .doc = "balls on the floor",
                                         .words = 2,
                                         .flags = SCREE_REQUIRED,
                                         .column_count = 2,
                                         .columns = columns}};
static const scree_generator generator = {.struct_size = sizeof generator,
                                          .object = {sizeof(scree_object), 1, places, create_table, free, set_table, 0},
                                          .generate = generate};

// A process with rows and a step: pulls downwards and counts its calls.
static const scree_property pulls[] = {NUMBER("gravity", "m/s2", 0, SCREE_REQUIRED, 0)};
static const scree_need needs[] = {{SCREE_MASS, SCREE_READ}, {SCREE_FORCE, SCREE_READ | SCREE_WRITE}};
static void rows(const void* self, const scree_rows* r) {
  for (uint32_t i = 0; i < r->n; ++i) r->word[3][i] -= r->word[0][i] * ((const numbers*)self)->value[0];
}
static int prepare(void* self, const scree_host* host, const scree_refusal* refusal) {
  (void)self, (void)refusal;
  host->publish(host->self, "calls", 0);
  return 0;
}
static int step(void* self, const scree_step* s, const scree_refusal* refusal) {
  (void)self, (void)refusal;
  s->state[0] += 1;
  s->host->publish(s->host->self, "calls", s->state[0]);
  return 0;
}
static const scree_process process = {.struct_size = sizeof process,
                                      .flags = SCREE_ADDS_FORCE,
                                      .object = {sizeof(scree_object), 1, pulls, create, free, set, 0},
                                      .state_words = 1,
                                      .need_count = 2,
                                      .every = 1,
                                      .needs = needs,
                                      .prepare = prepare,
                                      .rows = {rows},
                                      .step = step};

// A writer: a line per frame.
static int open_writer(void* self, const char* name, const scree_files* files, const scree_refusal* refusal) {
  (void)files, (void)refusal;
  snprintf(((numbers*)self)->name, 100, "%s.txt", name);
  return 0;
}
static int write_frame(void* self, const scree_frame* frame, const scree_files* files) {
  char line[200];
  const int n = snprintf(line, sizeof line, "%u %llu balls, %s %g\n", frame->index,
                         (unsigned long long)frame->ball_count, frame->quantity_names[0], frame->quantities[0]);
  return files->append(files->self, ((numbers*)self)->name, line, (uint64_t)n) ? 0 : 1;
}
static const scree_writer writer = {.struct_size = sizeof writer,
                                    .wants = SCREE_WANTS_BALLS | SCREE_WANTS_QUANTITIES,
                                    .object = {sizeof(scree_object), 0, 0, create, free, set, 0},
                                    .open = open_writer,
                                    .frame = write_frame};

#define TABLE(name) \
  static const void* name##_table(void) { return &name; }
TABLE(model)
TABLE(wall)
TABLE(generator)
TABLE(process)
TABLE(writer)
static const scree_component components[] = {{SCREE_CONTACT_MODEL, 0, "old", "1", "a spring", model_table},
                                             {SCREE_WALL, 0, "old", "1", "a floor", wall_table},
                                             {SCREE_GENERATOR, 0, "old", "1", "a row of balls", generator_table},
                                             {SCREE_PROCESS, 0, "old", "1", "a pull", process_table},
                                             {SCREE_WRITER, 0, "old", "1", "a line a frame", writer_table}};
__attribute__((visibility("default"))) const scree_plugin_header scree_plugin = {
    SCREE_MAGIC, sizeof(scree_plugin_header), 0, 1, "0.1.0", "C", 5, sizeof(scree_component), components};
