#pragma once
/// Writers: what turns frames into files. One plain struct, described by its settings, with
///
///     static constexpr uint32_t wants = SCREE_WANTS_BALLS | SCREE_WANTS_WALLS;   what a frame must hold
///     void open(const std::string& name, const Files& files);       `name`: the recorder's name in the scene
///     void frame(const scree_frame& frame, const Files& files);
///     void close(const Files& files);                               optional
///     std::string save() const;                                     optional: own memory, kept in checkpoints ...
///     void load(std::string_view bytes);                            ... and given back after `open` on a resume
///
/// [one thread] On a resume the program has cut the files back to the checkpoint before `open`, so a writer only goes
/// on appending. A frame and what it points to (abi.h) live until the call returns. `frame.index` counts the frames of
/// this recorder from 0, through resumes.
#include <scree/abi.h>
#include <scree/object.hpp>
#include <scree/plugin.hpp>

#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>

namespace scree {

/// The files of one recorder, below the output folder. Names are relative and hold one folder at most.
class Files {
 public:
  explicit Files(const scree_files& table) : table_(&table) {}
  /// Adds to the end of a file, which begins empty.
  void append(const std::string& name, std::string_view bytes) const {
    check(table_->append(table_->self, name.c_str(), bytes.data(), bytes.size()), name);
  }
  /// Writes a whole file at once; a reader sees the old file or the new one, never half of it.
  void replace(const std::string& name, std::string_view bytes) const {
    check(table_->replace(table_->self, name.c_str(), bytes.data(), bytes.size()), name);
  }

 private:
  static void check(int written, const std::string& name) {
    if (written == 0) throw std::runtime_error("cannot write " + name);
  }
  const scree_files* table_;
};

namespace writer_adapter {

template <class T>
void add_memory(scree_writer& table) {
  table.save = [](const void* self, void* bytes, uint64_t capacity) -> uint64_t {
    std::string state;
    if (guarded(nullptr, [&] { state = static_cast<const T*>(self)->save(); }) != 0) return UINT64_MAX;
    if (state.size() <= capacity && !state.empty()) std::memcpy(bytes, state.data(), state.size());
    return state.size();
  };
  table.load = [](void* self, const void* bytes, uint64_t size) {
    return guarded(nullptr, [&] {
      static_cast<T*>(self)->load(std::string_view(static_cast<const char*>(bytes), static_cast<std::size_t>(size)));
    });
  };
}

template <class T>
scree_writer make_table() {
  static_assert(
      requires(T & t, const std::string& name, const scree_frame& frame, const Files& files) {
        t.open(name, files);
        t.frame(frame, files);
        T::wants;
      },
      "scree: a writer needs 'static constexpr uint32_t wants', 'void open(const std::string& name, const Files&)' and "
      "'void frame(const scree_frame&, const Files&)'");
  scree_writer table{};
  table.struct_size = sizeof table;
  table.wants = T::wants;
  table.object = object_table<T>();
  table.open = [](void* self, const char* name, const scree_files* files, const scree_refusal* refusal) {
    return guarded(refusal, [&] { static_cast<T*>(self)->open(name, Files(*files)); });
  };
  table.frame = [](void* self, const scree_frame* frame, const scree_files* files) {
    return guarded(nullptr, [&] { static_cast<T*>(self)->frame(*frame, Files(*files)); });
  };
  if constexpr (requires(T & t, const Files& files) { t.close(files); })
    table.close = [](void* self, const scree_files* files) {
      return guarded(nullptr, [&] { static_cast<T*>(self)->close(Files(*files)); });
    };
  if constexpr (requires(T & t, std::string_view bytes) { t.save(), t.load(bytes); }) add_memory<T>(table);
  return table;
}

}  // namespace writer_adapter

/// One writer for SCREE_PLUGIN. `name` is what a scene writes after `writer:`.
template <class T>
constexpr scree_component writer(const char* name, const char* version, const char* doc = "") {
  return {SCREE_WRITER, 0, name, version, doc, []() -> const void* {
            static const scree_writer table = writer_adapter::make_table<T>();
            return &table;
          }};
}

}  // namespace scree
