#ifndef SCREE_ABI_H
#define SCREE_ABI_H
/* The boundary between scree and its plug-ins: plain C, versioned by size.
 *
 * Rules of growth: new fields only at the end of structs with struct_size, at which a reader looks first; scree_object
 * and the others never grow (docs/abi.md). SI units everywhere. A plug-in author does not read this file: the C++
 * headers beside it (contact_model.hpp, wall.hpp, generator.hpp, ...) fill these tables from one plain struct.
 *
 * Thread rules are written at each function: [any thread] may be called from several threads at once, on different
 * data; [one thread] is never called twice at the same time. */
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define SCREE_MAGIC 0x45524353u /* "SCRE" */
#define SCREE_ABI_MAJOR 0u      /* differs: refused */
#define SCREE_ABI_MINOR 1u      /* newer than the program's: refused */
#define SCREE_SDK_VERSION "0.1.0"
#define SCREE_BATCH 128u /* contacts in one batch, at most */
#define SCREE_ROWS 256u  /* balls in one row block handed to a process, at most */

enum { SCREE_CONTACT_MODEL = 1, SCREE_WALL = 2, SCREE_GENERATOR = 3, SCREE_PROCESS = 4, SCREE_WRITER = 5 };

/* ------------------------------------------------------------------ settings */

/* What a component can be told from a scene. */
enum {
  SCREE_NUMBER = 1,  /* one double */
  SCREE_INTEGER = 2, /* one double that holds an integer */
  SCREE_BOOLEAN = 3, /* one double, 0 or 1 */
  SCREE_VECTOR = 4,  /* three doubles */
  SCREE_TEXT = 5,    /* one string */
  SCREE_NUMBERS = 6, /* rows x 1 */
  SCREE_VECTORS = 7, /* rows x 3 */
  SCREE_TEXTS = 8,   /* list of strings */
  SCREE_TABLE = 9    /* list of records; rows x (sum of words of the columns) */
};
/* How a pair's value follows from the values of its two pieces. */
enum { SCREE_MIX_NONE = 0, SCREE_MIX_SERIES = 1, SCREE_MIX_LEAST = 2, SCREE_MIX_MEAN = 3, SCREE_MIX_HARMONIC = 4 };
enum {
  SCREE_REQUIRED = 1u << 0,
  SCREE_HAS_LOW = 1u << 1,  /* value >= low, or > low with SCREE_LOW_OPEN */
  SCREE_HAS_HIGH = 1u << 2, /* value <= high, or < high with SCREE_HIGH_OPEN */
  SCREE_LOW_OPEN = 1u << 3,
  SCREE_HIGH_OPEN = 1u << 4,
  SCREE_HAS_FALLBACK = 1u << 5,      /* `fallback` is used when the scene is silent */
  SCREE_POSITIVE_INFINITY = 1u << 6, /* .inf is a legal value */
  SCREE_DERIVED = 1u << 8,           /* contact model: computed by `derive`/`prepare`, not an input */
  SCREE_FILE = 1u << 9               /* text that names a file to read, relative to the scene's folder */
};

typedef struct scree_property {
  uint32_t struct_size, type;
  const char *name, *unit, *doc; /* unit "1" for a pure number; UDUNITS spelling, as in "kg/m3" */
  uint32_t word,
      words; /* contact model: first word in the rule's struct, number of words; table column: offset in a row */
  uint32_t flags, mix;
  double low, high, fallback;
  uint32_t forms;        /* bit k: belongs to alternative input form k; 0: always allowed */
  uint32_t column_count; /* SCREE_TABLE */
  const struct scree_property* columns;
  const char* choices; /* SCREE_TEXT: allowed words separated by one space, or null */
} scree_property;

/* One value on its way from a scene to a component. Numbers are SI. */
typedef struct scree_value {
  uint32_t struct_size, type;
  const double* numbers; /* rows x columns, row major */
  uint32_t rows, columns;
  const char* const* texts;
  uint32_t text_count, reserved;
} scree_value;

/* A refusal: the component writes why (UTF-8, truncated to size) and returns non-zero. */
typedef struct scree_refusal {
  uint32_t struct_size, size;
  char* why;
} scree_refusal;

/* Shared by walls, generators, processes and writers: an object made from settings. [one thread] */
typedef struct scree_object {
  uint32_t struct_size, property_count;
  const scree_property* properties;
  void* (*create)(void);
  void (*destroy)(void* self);
  int (*set)(void* self, uint32_t property, const scree_value* value, const scree_refusal* refusal);
  int (*check)(void* self, const scree_refusal* refusal); /* after all settings, may be null */
} scree_object;

/* Randomness comes from the host only (counter based, keyed by seed, purpose and the two indices), so it depends on
 * neither threads nor order. */
typedef struct scree_random {
  uint32_t struct_size, reserved;
  void* self;
  double (*uniform)(void* self, uint64_t index, uint64_t draw); /* [0, 1) */
  double (*normal)(void* self, uint64_t index, uint64_t draw);  /* mean 0, deviation 1 */
} scree_random;

/* ------------------------------------------------------------------ contact models */

/* [any thread] contacts that share one rule; n <= SCREE_BATCH; piece 1 has the lower id (ball-wall: the ball). */
typedef struct scree_batch {
  uint32_t struct_size, n;
  double dt;                  /* s, of the drift that led here; 0 after a start or an edit */
  const double *nx, *ny, *nz; /* unit normal from piece 1 to piece 2 */
  const double* gap;          /* m, negative when overlapping */
  const double *vx, *vy, *vz; /* velocity of 2 relative to 1 at the contact point, m/s */
  const double *wx, *wy, *wz; /* spin of 2 relative to 1, rad/s; null unless SCREE_NEEDS_SPIN */
  const double *tx, *ty, *tz; /* turn of the contact frame over the drift: tilt of the normal plus mean spin about the
                                 new normal, each as 2 tan(angle/2) along its axis; null unless SCREE_NEEDS_TURN */
  const double *r1, *r2;      /* m; a wall has r2 = 0, meaning flat */
  const double* mass;         /* effective mass m1 m2/(m1 + m2), kg; a wall counts as infinite */
  const uint8_t* bonded;      /* null in a touch list */
  const double* const* property; /* null where the rule is uniform, else one array per word of the rule's struct */
  double* const* state;          /* component-major; zero for a new contact */
  double *fx, *fy, *fz;          /* out: force on piece 2, N */
  double *mx, *my, *mz;          /* out: moment on piece 2 beyond that of the force, N m; only if SCREE_GIVES_MOMENT */
  double *event, *sliding;       /* out: break mode (0, 1 tension, 2 shear); 1 while sliding; null unless asked */
  double* const* energy;         /* out: null unless asked: strain (state), friction, dashpot, break (increments), J */
} scree_batch;

enum {
  SCREE_NEEDS_SPIN = 1u << 0, /* reads wx wy wz */
  SCREE_NEEDS_TURN = 1u << 1, /* state holds a vector that turns with the contact */
  SCREE_GIVES_MOMENT = 1u << 2,
  SCREE_NONLINEAR = 1u << 3, /* stiffness changes with the gap */
  SCREE_CAN_BOND = 1u << 4
};
/* A rule may need no tangential part at all (friction 0, no shear stiffness): answer of `needs`. */
enum { SCREE_NORMAL_ONLY = 1u << 16 };

typedef struct scree_state_word {
  const char *name, *unit;
  uint32_t word, words;
} scree_state_word;

/* What `derive` may look at: the pieces of a new contact. r2 = 0 means a flat wall. */
typedef struct scree_pair {
  uint32_t struct_size, reserved;
  double r1, r2, mass;
} scree_pair;

/* Tangent stiffness of each contact of a batch: N/m, N/m, N m/rad, N m/rad, shares of critical damping. */
typedef struct scree_stiffness {
  uint32_t struct_size, n;
  double *normal, *shear, *bending, *twist, *dashpot_normal, *dashpot_shear;
} scree_stiffness;

typedef uint32_t (*scree_law)(const void* rule,
                              const scree_batch* batch); /* number of breaks, UINT32_MAX: the law threw */

typedef struct scree_contact_model {
  uint32_t struct_size, flags;
  uint32_t property_count, state_count;
  const scree_property* properties;
  const scree_state_word* states;
  uint32_t rule_words, state_words, bond_words; /* doubles in the rule's struct, in State, in Bond */
  /* bit k: in input form k (bit 0 without forms) `derive` reads the pair, so what it computes varies with radii */
  uint32_t derived_from_pair;
  uint32_t form_count, reserved;
  const char* const* forms; /* alternative inputs, as in "kn ks" and "emod kratio"; null if none */
  /* [one thread] all inputs are in place: compute derived words, or refuse. May be null. */
  int (*prepare)(double* rule, uint32_t form, const scree_refusal* refusal);
  /* [any thread] properties that follow from the pair; null if none. `form`: the input form the scene used. */
  void (*derive)(double* rule, uint32_t form, const scree_pair* pair);
  double (*reach)(const double* rule,
                  const scree_pair* pair); /* [any thread] gap up to which the law runs, m; null: 0 */
  /* [one thread] flags this rule really needs, for leaving out: the model's flags, or SCREE_NORMAL_ONLY. Called with
   * the extreme values (largest of each word) when words vary. May be null. */
  uint32_t (*needs)(const double* rule);
  /* one entry per instruction set: baseline, x86-64-v3, x86-64-v4; null means the one before */
  scree_law uniform[3], varying[3], uniform_energy[3], varying_energy[3];
  scree_law bonded[3], bonded_varying[3];
  void (*stiffness)(const void* rule, const scree_batch* batch, const scree_stiffness* out); /* [any thread] */
  scree_law normal_only[3]; /* the law of a rule that needs no tangential part; null if none */
  /* [one thread] some inputs come from two pieces: `rule` holds them mixed word by word, piece1 and piece2 the words of
   * each piece, NaN for what a wall does not give. Before `prepare`; changes inputs, or refuses. May be null. */
  int (*mixed)(double* rule, const double* piece1, const double* piece2, uint32_t form, const scree_refusal* refusal);
} scree_contact_model;

/* ------------------------------------------------------------------ walls */

/* A wall is geometry in its own frame; pose, velocity, forces and contact state belong to the kernel. */
typedef struct scree_touches {
  uint32_t struct_size, capacity;
  uint32_t* ball;       /* index into the centres handed in */
  uint32_t* patch;      /* names the smooth piece of the surface, for contact state; stable while a contact lasts */
  double *nx, *ny, *nz; /* unit normal from the ball to the wall, in the wall's frame */
  double* distance;     /* signed distance of the centre from the surface along it, m: gap = distance - radius */
} scree_touches;

enum { SCREE_WALL_FLAT = 1u << 0 /* every patch is a plane */ };

typedef struct scree_wall {
  uint32_t struct_size, flags;
  scree_object object;
  /* [any thread] all touches of n balls whose surface distance is below reach[i] (a distance of the centre).
   * Returns how many there are; when more than out->capacity, only the first capacity are written and the host asks
   * again. UINT32_MAX when the author's code threw. */
  uint32_t (*touch)(const void* self, uint32_t n, const double* x, const double* y, const double* z,
                    const double* reach, const scree_touches* out);
  /* [one thread] polygons for pictures: calls polygon once per face with its corners; an unbounded face is cut to the
   * box [low, high] (wall's frame). May be null. */
  void (*outline)(const void* self, const double low[3], const double high[3], void* sink,
                  void (*polygon)(void* sink, uint32_t corners, const double* xyz));
  double (*area)(const void* self); /* m2, 0 when unbounded; may be null */
} scree_wall;

/* ------------------------------------------------------------------ generators */

enum { SCREE_BALL_DENSITY = 1, SCREE_BALL_VELOCITY = 2, SCREE_BALL_SPIN = 4, SCREE_BALL_ID = 8, SCREE_BALL_GROUP = 16 };
typedef struct scree_ball {
  uint32_t struct_size, given; /* which of the optional fields are given */
  double position[3], radius;  /* m */
  double density;              /* kg/m3 */
  double velocity[3], spin[3]; /* m/s, rad/s */
  uint64_t id;
  const char* group; /* sub-group of the set that is generated, as in "fine" -> "sand.fine" */
} scree_ball;

typedef struct scree_sink {
  uint32_t struct_size, reserved;
  void* self;
  int (*ball)(void* self, const scree_ball* ball); /* places it, overlaps allowed; 0: the host refuses, stop */
  int (*try_ball)(void* self,
                  const scree_ball* ball); /* 1 placed, 0 overlaps an earlier ball, a wall or leaves the cell */
  const scree_random* random;
  const double *cell_low, *cell_high; /* m; null without a cell */
  const uint8_t* periodic;            /* three flags; null without a cell */
  void (*warn)(void* self, const char* message);
} scree_sink;

typedef struct scree_generator {
  uint32_t struct_size, reserved;
  scree_object object;
  int (*generate)(const void* self, const scree_sink* sink, const scree_refusal* refusal); /* [one thread] */
} scree_generator;

/* ------------------------------------------------------------------ processes */

/* How a process uses a column. An optional column that the scene does not keep arrives as null word pointers. */
enum { SCREE_READ = 1, SCREE_WRITE = 2, SCREE_OPTIONAL = 4 };
/* Columns a process may ask for; append only. Forces and moments are the net ones. */
enum {
  SCREE_POSITION = 0,
  SCREE_VELOCITY = 1,
  SCREE_SPIN = 2,
  SCREE_FORCE = 3,
  SCREE_MOMENT = 4,
  SCREE_RADIUS = 5,
  SCREE_MASS = 6,
  SCREE_INERTIA = 7,
  SCREE_FIXED = 8,
  SCREE_COLUMN_COUNT = 9
};
/* SCREE_TRACES_ENERGY: the host keeps an energy balance, its terms are the quantities energy.* */
enum {
  SCREE_ADDS_FORCE = 1u << 0,
  SCREE_SCALES_FORCE = 1u << 1,
  SCREE_LOCAL_DAMPING = 1u << 2,
  SCREE_TRACES_ENERGY = 1u << 3
};

typedef struct scree_need {
  uint32_t column, access;
} scree_need;

/* [any thread] up to SCREE_ROWS free balls in L1, one array per word. Velocity and spin are those of the half step
 * before. */
typedef struct scree_rows {
  uint32_t struct_size, n;
  uint64_t first, cycle;
  double time, dt;     /* s */
  double* const* word; /* words of the needed columns, in the order declared; null where optional and not kept */
  double* sum; /* this block's sums, zero on entry; the host adds blocks in order; null on an evaluation for output */
} scree_rows;

typedef struct scree_wall_view {
  uint32_t struct_size, contacts;
  double force[3], moment[3], position[3]; /* on the wall, N, N m about its position; m */
  double area, stiffness;                  /* m2, 0 when unbounded; N/m, normal, sum over its active contacts */
  double velocity[3], spin[3];             /* writable by a model process */
} scree_wall_view;

/* [one thread, between phases] */
typedef struct scree_host {
  uint32_t struct_size, reserved;
  void* self;
  int (*wall)(void* self, const char* name, uint32_t* handle); /* 0: none; good until the next prepare */
  scree_wall_view* (*wall_view)(void* self, uint32_t handle);
  void (*publish)(void* self, const char* quantity, double value); /* as processes.NAME.quantity */
  const double* (*column)(void* self, uint32_t column, uint32_t component,
                          uint64_t* rows); /* valid until the call returns */
  const uint64_t* (*ids)(void* self, uint64_t* rows);
  int (*read)(void* self, const char* quantity, double* value); /* 0: no such quantity */
  /* Bonds, after this call of step, all pairs of a rule whose gap is at most `gap` m and which are not bonded; with
   * `again` 0 none whose bond broke. In prepare it only tells whether that is possible. 0: no such rule, or its contact
   * model makes no bonds, or the gap is not a number of at least 0. */
  int (*bond)(void* self, const char* rule, double gap, int again);
} scree_host;

typedef struct scree_step {
  uint32_t struct_size, reserved;
  uint64_t cycle;
  double time, dt;
  const double* sum; /* totals of the row sums of this cycle */
  double* state;     /* saved words of the process */
  const scree_host* host;
} scree_step;

typedef struct scree_process {
  uint32_t struct_size, flags;
  scree_object object;
  uint32_t sums, state_words, need_count, every; /* every: cycles between calls of step, 0 and 1 mean each */
  const scree_need* needs;
  int (*prepare)(void* self, const scree_host* host, const scree_refusal* refusal); /* [one thread], may be null */
  void (*rows[3])(const void* self, const scree_rows* rows);                        /* baseline, v3, v4; may be null */
  int (*step)(void* self, const scree_step* step, const scree_refusal* refusal);    /* [one thread], may be null */
  double (*damping)(const void* self); /* share of local damping, for the step; only with SCREE_LOCAL_DAMPING */
} scree_process;

/* ------------------------------------------------------------------ writers */

/* One array of a frame: `components` arrays of `count` doubles, component-major. */
typedef struct scree_array {
  const char *name, *unit;
  uint32_t components, reserved;
  const double* const* component;
} scree_array;
typedef struct scree_polygon {
  uint32_t corners, reserved;
  const double* xyz;
} scree_polygon;
typedef struct scree_wall_picture {
  const char* name;
  uint32_t polygon_count, reserved;
  const scree_polygon* polygons; /* in the scene's frame */
  double force[3], velocity[3];
} scree_wall_picture;

typedef struct scree_frame {
  uint32_t struct_size, index; /* index counts this writer's frames from 0 */
  uint64_t cycle;
  double time;
  uint64_t ball_count; /* balls in id order */
  const uint64_t* ball_id;
  const double *x, *y, *z, *radius;
  uint32_t ball_array_count, contact_array_count;
  const scree_array* ball_arrays; /* the fields asked for */
  uint64_t contact_count;         /* active contacts in pair order; 0 unless asked for */
  const double *contact_x, *contact_y, *contact_z;
  const uint64_t *contact_id1, *contact_id2; /* id2 is 0 for a wall contact */
  const scree_array* contact_arrays;
  uint32_t wall_count, quantity_count;
  const scree_wall_picture* walls;
  const char* const* quantity_names; /* as written in the scene */
  const char* const* quantity_units;
  const double* quantities;
} scree_frame;

/* Files under the output folder; names are relative and may hold one level of folder. Append only; what was written is
 * known to the host, which cuts files back on resume. */
typedef struct scree_files {
  uint32_t struct_size, reserved;
  void* self;
  int (*append)(void* self, const char* name, const void* bytes, uint64_t size);  /* 0: I/O failure, stop writing */
  int (*replace)(void* self, const char* name, const void* bytes, uint64_t size); /* whole file, atomically */
} scree_files;

enum { SCREE_WANTS_BALLS = 1, SCREE_WANTS_CONTACTS = 2, SCREE_WANTS_WALLS = 4, SCREE_WANTS_QUANTITIES = 8 };

typedef struct scree_writer {
  uint32_t struct_size, wants;
  scree_object object;
  /* [one thread] `name`: the recorder's name in the scene; `resumed`: frames already written. */
  int (*open)(void* self, const char* name, const scree_files* files, const scree_refusal* refusal);
  int (*frame)(void* self, const scree_frame* frame, const scree_files* files);
  int (*close)(void* self, const scree_files* files);
  uint64_t (*save)(const void* self, void* bytes, uint64_t capacity); /* size of its own state; may be null */
  int (*load)(void* self, const void* bytes, uint64_t size);
} scree_writer;

/* ------------------------------------------------------------------ the library */

typedef struct scree_component {
  uint32_t kind, reserved;
  const char *name, *version, *doc;
  const void* (*table)(void); /* scree_contact_model, scree_wall, ... by kind */
} scree_component;

/* The one exported symbol, `scree_plugin`: constant-initialised, readable without running the author's code. */
typedef struct scree_plugin_header {
  uint32_t magic, header_size, abi_major, abi_minor;
  const char *sdk, *compiler;
  uint32_t component_count, component_size;
  const scree_component* components;
} scree_plugin_header;

#ifdef __cplusplus
}
#endif
#endif
