#include "core/run/archive.hpp"

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>

#include "core/run/checkpoint_files.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using namespace scree::core;

namespace {

void write_sample(const std::string& path, const std::string& previous = "", uint64_t cycle = 17) {
  ArchiveWriter out(path);
  out.put_value<uint64_t>("cycle", cycle);
  out.put("ball.x", std::vector<double>{0.1, -0.0, std::numeric_limits<double>::quiet_NaN(), 5e-324});
  out.put("flags", std::vector<uint8_t>{1, 2, 3});
  out.put("group", std::vector<uint16_t>{65535, 7});
  out.put("row", std::vector<uint32_t>{4000000000u});
  out.put("empty", std::vector<double>{});
  out.put_text("scene", std::string("a\0b", 3));
  out.put_texts("names", {"sand", "", "gravel"});
  REQUIRE(out.commit(previous));
  REQUIRE(out.error().empty());
  REQUIRE(out.bytes() == std::filesystem::file_size(path));
}

/// "" when the file is accepted, the refusal otherwise; anything else fails the test.
std::string refusal(const std::string& path) {
  try {
    const ArchiveReader in(path);
    for (const std::string& name : in.names()) REQUIRE(in.has(name));
  } catch (const Refusal& refused) {
    REQUIRE(refused.code() == Exit::io);
    return refused.what();
  }
  return "";
}

template <class F>
std::string refusal_of(F f) {
  try {
    f();
  } catch (const Refusal& refused) {
    return refused.what();
  }
  return "";
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("an archive gives back the bits that were put in") {
  const TemporaryFolder folder;
  write_sample(folder / "a.scree");
  CHECK_FALSE(std::filesystem::exists(folder / "a.scree.tmp"));
  const ArchiveReader in(folder / "a.scree");
  CHECK(in.version() == SCREE_VERSION);
  CHECK(in.get_value<uint64_t>("cycle") == 17);
  const auto x = in.get<double>("ball.x", 4);
  CHECK(x[0] == 0.1);
  CHECK(std::signbit(x[1]));
  CHECK(std::isnan(x[2]));
  CHECK(x[3] == 5e-324);
  CHECK(in.get<uint8_t>("flags") == std::vector<uint8_t>{1, 2, 3});
  CHECK(in.get<uint16_t>("group") == std::vector<uint16_t>{65535, 7});
  CHECK(in.get<uint32_t>("row") == std::vector<uint32_t>{4000000000u});
  CHECK(in.get<double>("empty", 0).empty());
  CHECK(in.get_text("scene") == std::string("a\0b", 3));
  CHECK(in.get_texts("names") == std::vector<std::string>{"sand", "", "gravel"});
  CHECK(in.names().front() == "cycle");
  CHECK(in.names().size() == 8);
}

TEST_CASE("large sections pass the buffer") {
  const TemporaryFolder folder;
  std::vector<double> big(700000);
  for (size_t k = 0; k < big.size(); ++k) big[k] = static_cast<double>(k) * 0.1;
  ArchiveWriter out(folder / "big.scree");
  out.put_value<uint32_t>("one", 1);
  out.put("big", big);
  out.put("again", big);
  REQUIRE(out.commit());
  const ArchiveReader in(folder / "big.scree");
  CHECK(in.get<double>("big") == big);
  CHECK(in.get<double>("again") == big);
}

TEST_CASE("a section is refused by name, type and count") {
  const TemporaryFolder folder;
  write_sample(folder / "a.scree");
  const ArchiveReader in(folder / "a.scree");
  CHECK(holds(refusal_of([&] { in.get<double>("ball.y"); }), "section 'ball.y' is missing"));
  CHECK(holds(refusal_of([&] { in.get<uint64_t>("ball.x"); }),
              "section 'ball.x' holds numbers, expected 64-bit integers"));
  CHECK(holds(refusal_of([&] { in.get<double>("ball.x", 5); }), "section 'ball.x' holds 4 values, expected 5"));
  CHECK(holds(refusal_of([&] { in.get_text("names"); }), "expected text"));
  ArchiveWriter twice(folder / "b.scree");
  twice.put_value<uint8_t>("x", 1);
  CHECK_THROWS_AS(twice.put_value<uint8_t>("x", 1), std::logic_error);
}

TEST_CASE("every changed byte of a checkpoint is noticed") {
  const TemporaryFolder folder;
  write_sample(folder / "a.scree");
  const std::string sound = read_text(folder / "a.scree");
  const std::string path = folder / "b.scree";
  for (size_t k = 0; k < sound.size(); ++k)
    for (const int flip : {0x01, 0x80, 0xff}) {
      std::string broken = sound;
      broken[k] = static_cast<char>(broken[k] ^ flip);
      write_text(path, broken);
      const std::string why = refusal(path);
      INFO("byte " << k << " xor " << flip << ": " << why);
      REQUIRE(why.starts_with(path + ": "));
    }
  // A byte inside the values of a section names that section.
  std::string broken = sound;
  const size_t at = broken.find("ball.x") + 6;
  broken[at] = static_cast<char>(broken[at] ^ 1);
  write_text(path, broken);
  CHECK(refusal(path) == path + ": damaged: section 'ball.x'");
}

TEST_CASE("every shortened or lengthened checkpoint is noticed") {
  const TemporaryFolder folder;
  write_sample(folder / "a.scree");
  const std::string sound = read_text(folder / "a.scree");
  const std::string path = folder / "b.scree";
  for (size_t size = 0; size < sound.size(); ++size) {
    write_text(path, sound.substr(0, size));
    INFO("cut to " << size);
    REQUIRE_FALSE(refusal(path).empty());
  }
  for (const size_t more : {1u, 39u, 40u, 41u, 5000u}) {
    write_text(path, sound + std::string(more, '\0'));
    CHECK_FALSE(refusal(path).empty());
    write_text(path, sound + sound.substr(0, std::min(more, sound.size())));
    CHECK_FALSE(refusal(path).empty());
  }
  write_text(path, sound);
  CHECK(refusal(path).empty());
}

TEST_CASE("foreign files are refused before memory is asked for") {
  const TemporaryFolder folder;
  const std::string path = folder / "x.scree";
  CHECK(holds(refusal(path), "cannot open: No such file or directory"));
  CHECK(holds(refusal(folder.path()), "not a regular file"));
  write_text(path, "title: a scene\nballs: {}\n");
  CHECK(holds(refusal(path), "not a checkpoint of scree"));
  write_text(path, std::string(100000, '\xff'));
  CHECK(holds(refusal(path), "not a checkpoint of scree"));

  // A head that lies about its size, with a hash that fits: only the comparison with the file can stop it.
  write_sample(folder / "a.scree");
  std::string lie = read_text(folder / "a.scree");
  const uint64_t huge = uint64_t{1} << 50;
  std::memcpy(lie.data() + 64 + 16, &huge, sizeof huge);
  Hasher hasher;
  hasher.add(lie.data() + 64, 32);
  hasher.add("cycle");
  const uint64_t hash = hasher.value();
  std::memcpy(lie.data() + 64 + 32, &hash, sizeof hash);
  write_text(path, lie);
  CHECK(refusal(path) == path + ": damaged: the file ends inside section 'cycle'");

  // A later format, with a hash that fits.
  std::string later = read_text(folder / "a.scree");
  const uint32_t format = 2;
  std::memcpy(later.data() + 8, &format, sizeof format);
  const uint64_t header_hash = hash64(later.data(), 56);
  std::memcpy(later.data() + 56, &header_hash, sizeof header_hash);
  write_text(path, later);
  CHECK(holds(refusal(path), "checkpoint format 2, written by scree"));
}

TEST_CASE("a writer that is given up leaves the old file and no rest") {
  const TemporaryFolder folder;
  write_sample(folder / "a.scree");
  const std::string before = read_text(folder / "a.scree");
  {
    ArchiveWriter out(folder / "a.scree");
    out.put_value<uint64_t>("cycle", 18);
  }
  CHECK(read_text(folder / "a.scree") == before);
  CHECK_FALSE(std::filesystem::exists(folder / "a.scree.tmp"));
}

TEST_CASE("two checkpoints are kept, and a damaged one points at the other") {
  const TemporaryFolder folder;
  const CheckpointFiles files(folder / "job.out");
  std::filesystem::create_directory(folder / "job.out");
  CHECK(files.prepare() == 0);
  CHECK(files.prepare() == 0);
  CHECK_FALSE(files.any());
  for (const uint64_t cycle : {100u, 200u, 300u}) write_sample(files.latest, files.previous, cycle);
  CHECK(files.open_latest().get_value<uint64_t>("cycle") == 300);
  CHECK(files.open_previous().get_value<uint64_t>("cycle") == 200);

  write_text(files.latest + ".tmp", "half");
  write_text(files.folder + "/mine.tmp", "of the user");
  files.clean();
  CHECK_FALSE(std::filesystem::exists(files.latest + ".tmp"));
  CHECK(std::filesystem::exists(files.folder + "/mine.tmp"));

  std::string broken = read_text(files.latest);
  broken[broken.size() / 2] ^= 4;
  write_text(files.latest, broken);
  const std::string with_previous = refusal_of([&] { files.open_latest(); });
  CHECK(holds(with_previous, "latest.scree: damaged: "));
  CHECK(holds(with_previous,
              "the previous checkpoint is sound: `scree resume " + (folder / "job.out") + " --from previous`"));
  write_text(files.previous, "x");
  CHECK(holds(refusal_of([&] { files.open_latest(); }), "and the previous checkpoint cannot be used"));
  std::filesystem::remove(files.previous);
  CHECK(holds(refusal_of([&] { files.open_latest(); }), "there is no previous checkpoint"));
}
