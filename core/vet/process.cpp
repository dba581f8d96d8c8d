#include <algorithm>
#include <chrono>
#include <map>

#include "core/vet/kind_checks.hpp"
#include "core/vet/object.hpp"
#include "core/vet/purity.hpp"
#include "core/vet/row_bench.hpp"

namespace scree::core::vet {

namespace {

constexpr std::size_t row_count = 300;

const scree_process& table_of(const Subject& subject) { return subject.component->process(); }
const void* code_of(const Subject& subject) { return reinterpret_cast<const void*>(table_of(subject).rows[0]); }
void require_rows(const Subject& subject) {
  if (table_of(subject).rows[0] == nullptr) throw Skipped("it acts between cycles only, on no rows of balls");
}

std::vector<Isa> usable_sets() {
  std::vector<Isa> list;
  for (const Isa isa : {Isa::baseline, Isa::v3, Isa::v4})
    if (isa <= detect_isa()) list.push_back(isa);
  return list;
}

/// A scene with one wall of any name and no balls, for `prepare` and `step`.
class Scene {
 public:
  Scene() {
    view_ = {sizeof(scree_wall_view), 3, {0, 0, -10}, {0, 0, 0}, {0, 0, 0}, 1, 1e6, {0, 0, 0}, {0, 0, 0}};
    for (std::size_t i = 0; i < ids_.size(); ++i) ids_[i] = i + 1;
    table_ = {sizeof(scree_host), 0, this, &wall, &wall_view, &publish, &column, &ids, &read, &bond};
  }
  const scree_host* host() const { return &table_; }
  bool finite() const {
    return std::all_of(published_.begin(), published_.end(), [](const auto& p) { return std::isfinite(p.second); }) &&
           std::isfinite(view_.velocity[0] + view_.velocity[1] + view_.velocity[2]);
  }

 private:
  static Scene& self(void* s) { return *static_cast<Scene*>(s); }
  static int wall(void*, const char*, uint32_t* handle) { return *handle = 0, 1; }
  static scree_wall_view* wall_view(void* s, uint32_t handle) { return handle == 0 ? &self(s).view_ : nullptr; }
  static void publish(void* s, const char* name, double value) { self(s).published_[name] = value; }
  static const double* column(void* s, uint32_t column, uint32_t component, uint64_t* rows) {
    Scene& scene = self(s);
    *rows = scene.ids_.size();
    std::vector<double>& values = scene.columns_[{column, component}];
    if (values.empty())
      for (std::size_t i = 0; i < *rows; ++i)
        values.push_back(column >= SCREE_RADIUS ? 0.01 : 0.03 * static_cast<double>(i));
    return values.data();
  }
  static const uint64_t* ids(void* s, uint64_t* rows) { return *rows = self(s).ids_.size(), self(s).ids_.data(); }
  static int read(void*, const char*, double* value) { return *value = 1, 1; }
  static int bond(void*, const char*, double, int) { return 1; }

  scree_wall_view view_{};
  std::map<std::string, double> published_;
  std::map<std::pair<uint32_t, uint32_t>, std::vector<double>> columns_;
  std::vector<uint64_t> ids_ = std::vector<uint64_t>(5);
  scree_host table_{};
};

/// Calls f(object, settings) for processes that accept their settings and this scene.
template <class F>
void for_processes(const Subject& subject, F f) {
  const scree_process& table = table_of(subject);
  std::string why;
  std::size_t ready = 0;
  Scene scene;
  for (const Settings& settings : accepted_settings(subject, 12)) {
    Object object(table.object);
    object.set_all(settings);
    Refused refused;
    if (table.prepare != nullptr && table.prepare(object.get(), scene.host(), &refused.table) != 0) {
      why = refused.why;
      continue;
    }
    ++ready;
    f(object.get(), settings);
  }
  if (ready == 0) throw Skipped("'prepare' refuses a scene with one wall and five balls: " + why);
}

template <class Run>
void each_call(const Subject& subject, const Run& run) {
  require_rows(subject);
  const scree_process& table = table_of(subject);
  for_processes(subject, [&](const void* process, const Settings& settings) {
    RowBench bench(table, SCREE_ROWS, 21, true);
    for (const Isa isa : usable_sets()) {
      const auto rows = pick(table.rows, isa);
      const scree_rows block = bench.prepared(0, SCREE_ROWS);
      const auto call = [&] { rows(process, &block); };
      run(call, [&] { return text_of(table.object, settings); });
    }
  });
}

}  // namespace

Outcome process_bits(const Subject& subject) {
  require_rows(subject);
  Worst worst;
  for_processes(subject, [&](const void* process, const Settings& settings) {
    RowBench reference(table_of(subject), row_count, 22, true);
    reference.run(process, Isa::baseline, SCREE_ROWS);
    for (const Isa isa : usable_sets())
      for (const std::size_t block : {256u, 8u, 7u, 1u}) {
        RowBench bench(table_of(subject), row_count, 22, true);
        bench.run(process, isa, block);
        worst.see(bench.bits() == reference.bits() ? 0 : 1, [&] {
          return fmt::format("{} in blocks of {} gives other bits than baseline in blocks of 256; {}", isa_name(isa),
                             block, text_of(table_of(subject).object, settings));
        });
      }
  });
  return worst.judged(0,
                      "a ball's answer must not depend on its place in the block; no function of the C library but "
                      "sqrt; build with scree_add_plugin()");
}

Outcome process_columns(const Subject& subject) {
  require_rows(subject);
  Worst worst;
  for_processes(subject, [&](const void* process, const Settings& settings) {
    for (const bool kept : {true, false})
      for (const Isa isa : usable_sets()) {
        RowBench bench(table_of(subject), row_count, 23, kept);
        bench.run(process, isa, 100);
        const std::string trespass = bench.trespass();
        worst.see(trespass.empty() ? 0 : 1,
                  [&] { return "it wrote " + trespass + "; " + text_of(table_of(subject).object, settings); });
      }
  });
  return worst.judged(0, "write only columns that are declared as written: a 'const' parameter of 'ball' reads");
}

Outcome process_extremes(const Subject& subject) {
  require_rows(subject);
  Worst worst;
  for_processes(subject, [&](const void* process, const Settings& settings) {
    for (const double dt : {0.0, 1e-12, 1e-3})
      for (uint64_t seed = 0; seed < 8; ++seed) {
        RowBench bench(table_of(subject), row_count, seed, true);
        bench.fill(seed, true);
        bench.dt = dt;
        bench.run(process, Isa::baseline, SCREE_ROWS);
        worst.see(bench.finite() ? 0 : 1, [&] {
          return fmt::format("finite columns became infinite or not a number at dt {:g} s; {}", dt,
                             text_of(table_of(subject).object, settings));
        });
      }
  });
  return worst.judged(0, "look for a division by zero, by a velocity that may be zero for one");
}

Outcome process_allocates(const Subject& subject) {
  require_rows(subject);
  return nothing_allocated(code_of(subject), [&](const auto& run) { each_call(subject, run); });
}
Outcome process_global_state(const Subject& subject) {
  require_rows(subject);
  return nothing_kept(code_of(subject), [&](const auto& run) { each_call(subject, run); });
}
Outcome process_float_mode(const Subject& subject) {
  require_rows(subject);
  return mode_kept([&](const auto& run) { each_call(subject, run); });
}

Outcome process_step(const Subject& subject) {
  const scree_process& table = table_of(subject);
  if (table.step == nullptr) throw Skipped("it does nothing between cycles");
  std::size_t steps = 0, refusals = 0;
  for_processes(subject, [&](void* process, const Settings& settings) {
    Scene scene;
    constexpr double mark = -6.27e66;
    std::vector<double> state(table.state_words + 8, mark), sums(table.sums + 1, 1.0);
    std::fill_n(state.begin(), table.state_words, 0.0);
    for (uint64_t cycle = 0; cycle < 50; ++cycle) {
      const scree_step step{
          sizeof(scree_step), 0,           cycle, 1e-5 * static_cast<double>(cycle), 1e-5, sums.data(),
          state.data(),       scene.host()};
      Refused refused;
      if (table.step(process, &step, &refused.table) != 0) {
        if (refused.why[0] == 0)
          throw Failed("'step' refuses without a reason; " + text_of(table.object, settings),
                       "throw a std::exception that says why");
        ++refusals;
        break;
      }
      ++steps;
      for (std::size_t k = table.state_words; k < state.size(); ++k)
        if (state[k] != mark) throw Failed("'step' writes beyond its State", "declare every saved word in State");
      if (!scene.finite())
        throw Failed("'step' published what is not finite, or moved a wall so; " + text_of(table.object, settings),
                     "look for a division by an area, a force or a step of zero");
    }
  });
  return passed(fmt::format("{} steps, {} refusals with their reason", steps, refusals));
}

Outcome process_damping(const Subject& subject) {
  const scree_process& table = table_of(subject);
  if ((table.flags & SCREE_LOCAL_DAMPING) == 0) throw Skipped("it damps nothing");
  for_processes(subject, [&](const void* process, const Settings& settings) {
    const double share = table.damping(process);
    if (!(share >= 0 && share < 1))
      throw Failed(fmt::format("'damping' is {}; {}", share, text_of(table.object, settings)),
                   "a share, at least 0 and below 1");
  });
  return passed();
}

Outcome process_speed(const Subject& subject) {
  require_rows(subject);
  const scree_process& table = table_of(subject);
  std::string text;
  double best = 0, base = 0;
  bool done = false;
  for_processes(subject, [&](const void* process, const Settings&) {
    if (done) return;
    done = true;
    RowBench bench(table, SCREE_ROWS, 24, true);
    for (const Isa isa : usable_sets()) {
      const auto rows = pick(table.rows, isa);
      std::vector<double> times;
      for (int round = 0; round < 41; ++round) {
        bench.fill(24, false);
        const scree_rows block = bench.prepared(0, SCREE_ROWS);
        const auto start = std::chrono::steady_clock::now();
        for (int k = 0; k < 100; ++k) rows(process, &block);
        times.push_back(std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count() /
                        (100.0 * SCREE_ROWS));
      }
      std::nth_element(times.begin(), times.begin() + 20, times.end());
      best = times[20];
      if (isa == Isa::baseline) base = best;
      text += fmt::format("{}{} {:.2f}", text.empty() ? "" : ", ", isa_name(isa), best);
    }
  });
  text += fmt::format(" ns per ball; the widest takes {:.2f} of baseline", best / base);
  return {Verdict::info, text, "", best, NAN};
}

}  // namespace scree::core::vet
