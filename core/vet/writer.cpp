#include <limits>
#include <map>

#include "core/base/log.hpp"
#include "core/vet/kind_checks.hpp"
#include "core/vet/object.hpp"

namespace scree::core::vet {

namespace {

/// Files in memory, on a disk that may be full.
class Disk {
 public:
  Disk() { table_ = {sizeof(scree_files), 0, this, &append, &replace}; }
  Disk(const Disk&) = delete;
  Disk& operator=(const Disk&) = delete;
  const scree_files* table() const { return &table_; }

  std::map<std::string, std::string> files;
  std::string wrong_name;
  bool full = false;

 private:
  static std::string* file(void* self, const char* name) {
    Disk& disk = *static_cast<Disk*>(self);
    const std::string text = name != nullptr ? name : "";
    std::size_t slashes = 0;
    for (const char c : text) slashes += c == '/';
    if (text.empty() || text.front() == '/' || text.back() == '/' || slashes > 1 ||
        text.find("..") != std::string::npos)
      disk.wrong_name = text.empty() ? "(no name)" : text;
    return disk.full ? nullptr : &disk.files[text];
  }
  static int append(void* self, const char* name, const void* bytes, uint64_t size) {
    std::string* text = file(self, name);
    if (text != nullptr && size > 0) text->append(static_cast<const char*>(bytes), size);
    return text != nullptr;
  }
  static int replace(void* self, const char* name, const void* bytes, uint64_t size) {
    std::string* text = file(self, name);
    if (text != nullptr) text->assign(static_cast<const char*>(bytes), size);
    return text != nullptr;
  }
  scree_files table_{};
};

/// A small frame with everything that a writer may want.
class Sample {
 public:
  Sample(uint32_t index, std::size_t balls, std::size_t contacts, double odd = 0.5) {
    for (std::size_t i = 0; i < balls; ++i) ids_.push_back(2 * i + 1);
    for (auto& column : ball_) column.assign(balls, 0.25 + index);
    for (auto& column : contact_) column.assign(contacts, 0.5 + index);
    for (std::size_t i = 0; i < contacts; ++i) id1_.push_back(i + 1), id2_.push_back(i + 1 == contacts ? 0 : i + 2);
    if (balls > 1) ball_[0][1] = odd;
    frame_.struct_size = sizeof frame_;
    frame_.index = index;
    frame_.cycle = 100 * uint64_t{index};
    frame_.time = 0.1 * index;
    frame_.ball_count = balls;
    frame_.ball_id = ids_.data();
    frame_.x = ball_[0].data(), frame_.y = ball_[1].data(), frame_.z = ball_[2].data(), frame_.radius = ball_[3].data();
    for (std::size_t k = 0; k < 3; ++k) vector_[k] = ball_[k].data(), force_[k] = contact_[k].data();
    arrays_[0] = {"velocity", "m/s", 3, 0, vector_};
    arrays_[1] = {"force", "N", 3, 0, force_};
    frame_.ball_array_count = frame_.contact_array_count = 1;
    frame_.ball_arrays = &arrays_[0];
    frame_.contact_arrays = &arrays_[1];
    frame_.contact_count = contacts;
    frame_.contact_x = contact_[0].data(), frame_.contact_y = contact_[1].data(), frame_.contact_z = contact_[2].data();
    frame_.contact_id1 = id1_.data(), frame_.contact_id2 = id2_.data();
    polygon_ = {3, 0, corners_};
    wall_ = {"floor", 1, 0, &polygon_, {0, 0, -1}, {0, 0, 0}};
    frame_.wall_count = balls > 0 ? 1 : 0;
    frame_.walls = &wall_;
    quantities_[1] = odd;
    frame_.quantity_count = balls > 0 ? 2 : 0;
    frame_.quantity_names = names_;
    frame_.quantity_units = units_;
    frame_.quantities = quantities_;
  }
  Sample(const Sample&) = delete;
  Sample& operator=(const Sample&) = delete;
  const scree_frame* frame() const { return &frame_; }

 private:
  std::vector<uint64_t> ids_, id1_, id2_;
  std::vector<double> ball_[4], contact_[3];
  const double* vector_[3];
  const double* force_[3];
  scree_array arrays_[2];
  const double corners_[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  scree_polygon polygon_{};
  scree_wall_picture wall_{};
  const char* const names_[2] = {"unbalanced", "walls.floor.force, \"z\""};
  const char* const units_[2] = {"1", "N"};
  double quantities_[2] = {0.01, 0};
  scree_frame frame_{};
};

const scree_writer& table_of(const Subject& subject) { return subject.component->writer(); }

/// A recording: frames one after the other, cut by a checkpoint or not.
class Recording {
 public:
  Recording(const scree_writer& table, const Settings& settings, Disk& disk)
      : table_(table), disk_(disk), object_(table.object) {
    object_.set_all(settings);
    Refused refused;
    if (table.open(object_.get(), "record", disk.table(), &refused.table) != 0)
      throw Failed(std::string("'open' refuses: ") + refused.why, "refuse settings in 'check', not in 'open'");
  }
  bool frame(const Sample& sample) { return table_.frame(object_.get(), sample.frame(), disk_.table()) == 0; }
  bool close() { return table_.close == nullptr || table_.close(object_.get(), disk_.table()) == 0; }
  std::string saved() const {
    if (table_.save == nullptr) return "";
    std::string bytes(static_cast<std::size_t>(table_.save(object_.get(), nullptr, 0)), '\0');
    if (!bytes.empty()) table_.save(object_.get(), bytes.data(), bytes.size());
    return bytes;
  }
  void load(const std::string& bytes) {
    if (table_.load != nullptr && table_.load(object_.get(), bytes.data(), bytes.size()) != 0)
      throw Failed("'load' refuses what 'save' gave", "read what was written");
  }

 private:
  const scree_writer& table_;
  Disk& disk_;
  Object object_;
};

template <class F>
void for_settings(const Subject& subject, F f) {
  for (const Settings& settings : accepted_settings(subject, 8)) f(settings);
}

void require(bool good, const std::string& what, const std::string& next) {
  if (!good) throw Failed(what, next);
}

}  // namespace

Outcome writer_frames(const Subject& subject) {
  std::size_t bytes = 0;
  const double odd[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 5e-324,
                        -1e308};
  for_settings(subject, [&](const Settings& settings) {
    Disk disk;
    Recording recording(table_of(subject), settings, disk);
    uint32_t index = 0;
    require(recording.frame(Sample(index++, 3, 2)), "a frame of three balls is refused", "write it");
    require(recording.frame(Sample(index++, 0, 0)), "a frame without balls is refused", "write an empty frame");
    for (const double value : odd)
      require(recording.frame(Sample(index++, 3, 2, value)), fmt::format("a frame that holds {} is refused", value),
              "write any number that a double may hold");
    require(recording.close(), "'close' fails", "close what was opened");
    require(disk.wrong_name.empty(), "it writes to '" + disk.wrong_name + "'",
            "names are relative to the output folder and hold one folder at most");
    for (const auto& [name, text] : disk.files) bytes += text.size();
    require(bytes > 0, "nothing was written", "write frames through Files");
  });
  return passed(fmt::format("{} bytes", bytes));
}

Outcome writer_repeatable(const Subject& subject) {
  for_settings(subject, [&](const Settings& settings) {
    std::map<std::string, std::string> first;
    for (const int turn : {0, 1}) {
      Disk disk;
      Recording recording(table_of(subject), settings, disk);
      for (uint32_t k = 0; k < 3; ++k) recording.frame(Sample(k, 3, 2));
      recording.close();
      if (turn == 0) first = disk.files;
      require(disk.files == first, "the same frames give other bytes the second time",
              "a file may depend on frames and settings only: no clock, no counter beside the object");
    }
  });
  return passed();
}

Outcome writer_full_disk(const Subject& subject) {
  for_settings(subject, [&](const Settings& settings) {
    Disk disk;
    Recording recording(table_of(subject), settings, disk);
    disk.full = true;
    const bool frame = recording.frame(Sample(0, 3, 2)), close = recording.close();
    require(!(frame && close) || disk.files.empty() == false, "a disk that takes nothing goes unnoticed",
            "let the exception of Files pass");
    disk.full = false;
    recording.frame(Sample(1, 3, 2));
  });
  return passed();
}

Outcome writer_resume(const Subject& subject) {
  for_settings(subject, [&](const Settings& settings) {
    Disk whole, cut;
    {
      Recording recording(table_of(subject), settings, whole);
      for (uint32_t k = 0; k < 4; ++k) recording.frame(Sample(k, 3, 2));
      recording.close();
    }
    std::string saved;
    {
      Recording before(table_of(subject), settings, cut);
      for (uint32_t k = 0; k < 2; ++k) before.frame(Sample(k, 3, 2));
      saved = before.saved();
    }
    {
      Recording after(table_of(subject), settings, cut);
      after.load(saved);
      for (uint32_t k = 2; k < 4; ++k) after.frame(Sample(k, 3, 2));
      after.close();
    }
    for (const auto& [name, text] : whole.files)
      require(cut.files[name] == text, "after a resume '" + name + "' has other bytes than without a cut",
              "keep in 'save' what frames after a resume need; write headers for frame.index 0 only");
  });
  return passed();
}

}  // namespace scree::core::vet
