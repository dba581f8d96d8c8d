#include "core/run/recorder.hpp"

#include <cmath>
#include <vector>

#include "core/base/crash_note.hpp"

namespace scree::core {

Recorder::Recorder(Simulation& simulation, Quantities& quantities, const Record& record, OutputFiles& files)
    : simulation_(simulation),
      quantities_(quantities),
      record_(record),
      files_(files),
      table_(record.writer.component->writer()),
      writer_(make_object(table_.object, record.writer, "record '" + record.name + "'")),
      abi_(files.abi()) {
  content_.wants = table_.wants;
  content_.fields = chosen_fields(record.fields, record.name);
  content_.quantities = record.quantities;
  check_content();
}

/// What a writer does not show would be lost without a word.
void Recorder::check_content() const {
  const auto refuse = [&](const std::string& key, const Place& place) {
    throw SceneErrors({place.text() + ": error: record '" + record_.name + "': the writer '" +
                       record_.writer.component->name + "' shows no " + key +
                       ": leave them out, or use another writer"});
  };
  if (!content_.fields.balls.empty() && (table_.wants & SCREE_WANTS_BALLS) == 0)
    refuse("fields of balls", record_.fields[0].place);
  if (!content_.fields.contacts.empty() && (table_.wants & SCREE_WANTS_CONTACTS) == 0)
    refuse("fields of contacts", record_.fields[0].place);
  if (!content_.quantities.empty() && (table_.wants & SCREE_WANTS_QUANTITIES) == 0)
    refuse("quantities", content_.quantities[0]->place());
}

void Recorder::open() {
  if (open_) return;
  char why[512] = "";
  const scree_refusal refusal{sizeof(scree_refusal), sizeof why, why};
  if (table_.open != nullptr && table_.open(writer_.get(), record_.name.c_str(), &abi_, &refusal) != 0)
    throw SceneErrors({record_.place.text() + ": error: record '" + record_.name + "': " + why});
  open_ = true;
}

bool Recorder::due() const {
  const Clock& clock = simulation_.engine.clock;
  if (!error_.empty() || clock.cycle == last_cycle_) return false;
  if (frames_ == 0) return true;
  if (record_.every.cycles) return clock.cycle % *record_.every.cycles == 0;
  // Half a step early counts, so that a frame lands on the cycle nearest to its time.
  return record_.every.time && clock.time() >= static_cast<double>(passed_ + 1) * *record_.every.time - 0.5 * clock.dt;
}

Needs Recorder::needs() const {
  Needs sum;
  for (const auto& formula : content_.quantities) sum |= quantities_.needs(*formula);
  sum.report = sum.report || !content_.fields.contacts.empty();
  return sum;
}

void Recorder::fail(const std::string& what) {
  error_ = "record '" + record_.name + "' " + what;
  if (files_.failed()) error_ += ": " + files_.error();
  simulation_.warn(error_ + "; the run goes on without it");
}

void Recorder::write() {
  const Clock& clock = simulation_.engine.clock;
  if (!error_.empty() || clock.cycle == last_cycle_) return;
  open();
  if ((content_.wants & SCREE_WANTS_WALLS) != 0) box_.follow(simulation_.engine);
  const Frame frame(simulation_, quantities_, content_, static_cast<uint32_t>(frames_), box_);
  crash_note = {record_.writer.component->name.c_str(), record_.name.c_str(), clock.cycle};
  const int failed = table_.frame(writer_.get(), &frame.abi(), &abi_);
  crash_note = CrashNote{};
  if (failed != 0) return fail("could not write its frame of cycle " + std::to_string(clock.cycle));
  ++frames_;
  last_cycle_ = clock.cycle;
  if (record_.every.time)
    passed_ = static_cast<uint64_t>(std::floor((clock.time() + 0.5 * clock.dt) / *record_.every.time));
}

void Recorder::finish() {
  write();
  close();
}

void Recorder::close() {
  if (!open_) return;
  open_ = false;
  if (error_.empty() && table_.close != nullptr && table_.close(writer_.get(), &abi_) != 0) fail("could not be closed");
}

void Recorder::save(ArchiveWriter& archive, const std::string& prefix) const {
  archive.put(prefix + "/counters", std::vector<uint64_t>{frames_, last_cycle_, passed_});
  std::vector<uint8_t> bytes;
  if (table_.save != nullptr) {
    const uint64_t size = table_.save(writer_.get(), nullptr, 0);
    if (size != UINT64_MAX) bytes.resize(static_cast<std::size_t>(size));
    if (size == UINT64_MAX || (size > 0 && table_.save(writer_.get(), bytes.data(), size) != size))
      throw Refusal(Exit::plugin, "record '" + record_.name + "': the writer could not save its state");
  }
  archive.put(prefix + "/writer", bytes);
  archive.put(prefix + "/box", box_.saved());
}

void Recorder::load(const ArchiveReader& archive, const std::string& prefix) {
  const std::vector<uint64_t> counters = archive.get<uint64_t>(prefix + "/counters", 3);
  frames_ = counters[0];
  last_cycle_ = counters[1];
  passed_ = counters[2];
  box_.restore(archive.get<double>(prefix + "/box"));
  const std::vector<uint8_t> bytes = archive.get<uint8_t>(prefix + "/writer");
  open();
  if (table_.load != nullptr && table_.load(writer_.get(), bytes.data(), bytes.size()) != 0)
    throw Refusal(Exit::io, archive.path() + ": section '" + prefix + "/writer': the writer of record '" +
                                record_.name + "' cannot read its saved state");
}

}  // namespace scree::core
