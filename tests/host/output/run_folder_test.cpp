// The folder of a run, by those who live in it: what stays of earlier runs, who makes which frame, and what
// is left behind. Locks belong to open files, so that two of them are two processes even within one.

#include "engine/model/error.h"
#include "host/output/run/run_folder.h"
#include "tests/host/output/directory_content.h"
#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>
#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <string>
#include <sys/stat.h>

using namespace pmdsim;

namespace {

using Earlier = RunFolder::Earlier;
using Claim = RunFolder::Claim;

RunIdentity run_named(const std::string &name) { return {{{"program", "pmdsim"}, {"name", name}}, name}; }

void never() { FAIL("nobody is to be waited for"); }

struct Folder {
  pmdsim::test::TemporaryFolder temporary;
  std::filesystem::path path = temporary.path() / "out";

  RunFolder entered(const std::string &run = "a", Earlier earlier = Earlier::made_again,
                    const FrameRange &frames = {0, 100}) const {
    return {path, run_named(run), frames, earlier, never};
  }

  // One sensor's file with the frame's number and what is `held`.
  void make(RunFolder &folder, std::uint32_t frame, const std::string &held = "") const {
    REQUIRE(folder.claim(frame) == Claim::granted);
    FrameRecord record;
    record.sensor.name = "pmd";
    record.frame = frame;
    OutputSet files(path);
    const std::string name = fmt::format("pmd_{:04}.txt", frame), text = fmt::format("{}{}", frame, held);
    files.add(name, [&](OutputFile &file) { file.write(text); });
    record.outputs.push_back({name, text.size()});
    RunFolder::add_record(files, record_json(folder.run().hash, {record}));
    folder.publish(files, frame);
  }

  std::vector<int> listed() const {
    std::vector<int> frames;
    const auto manifest = nlohmann::json::parse(content_of(path / "manifest.json"));
    for (const auto &frame : manifest.at("frames"))
      frames.push_back(frame.at("frame"));
    return frames;
  }
};

Error error_of(const std::function<void()> &call) {
  try {
    call();
  } catch (const Error &error) {
    CHECK(std::string(error.what()).find('\n') == std::string::npos);
    return error;
  }
  return {ExitCode::done, "none"};
}

} // namespace

TEST_CASE("a frame is one process's at a time, and once only") {
  const Folder folder;
  RunFolder first = folder.entered();
  CHECK_FALSE(first.is_joined());
  CHECK(first.has_locks());
  RunFolder second = folder.entered();
  CHECK(second.is_joined());
  CHECK(first.seems_free(3));
  REQUIRE(first.claim(3) == Claim::granted);
  CHECK(second.claim(3) == Claim::taken);
  CHECK_FALSE(second.seems_free(3));
  first.give_back(3);
  CHECK(second.seems_free(3));
  folder.make(second, 3);
  CHECK(first.claim(3) == Claim::whole);
  CHECK_FALSE(first.seems_free(3));
  CHECK(second.claim(3) == Claim::whole);
  CHECK(first.claim(4) == Claim::granted);
}

TEST_CASE("the manifest is that of all records, by whoever writes it last") {
  const Folder folder;
  RunFolder first = folder.entered(), second = folder.entered();
  folder.make(first, 0);
  folder.make(second, 1);
  CHECK(first.write_manifest() == 2);
  folder.make(second, 10);
  CHECK(folder.listed() == std::vector{0, 1});
  CHECK(second.write_manifest() == 3);
  CHECK(folder.listed() == std::vector{0, 1, 10});
}

TEST_CASE("of the same run only frames that are asked for are made again, and none that are to be kept") {
  const Folder folder;
  {
    RunFolder before = folder.entered();
    for (const std::uint32_t frame : {0u, 1u, 2u})
      folder.make(before, frame);
    before.write_manifest();
  }
  SECTION("kept") {
    RunFolder after = folder.entered("a", Earlier::kept);
    CHECK_FALSE(after.is_joined());
    CHECK(after.whole(1));
    CHECK(folder.listed().size() == 3);
  }
  SECTION("made again") {
    RunFolder after = folder.entered("a", Earlier::made_again, {1, 2});
    CHECK(after.whole(0));
    CHECK_FALSE(after.whole(1));
    CHECK(after.whole(2));
    CHECK_FALSE(std::filesystem::exists(folder.path / "manifest.json"));
  }
  SECTION("others are asked for") {
    RunFolder after = folder.entered("a", Earlier::made_again, {5, 9});
    CHECK(after.whole(1));
    CHECK(folder.listed().size() == 3);
  }
  SECTION("beside a living process they are kept in any case") {
    RunFolder living = folder.entered("a", Earlier::kept);
    RunFolder after = folder.entered();
    CHECK(after.whole(1));
  }
}

TEST_CASE("another run replaces one that nobody is at, unless its frames are to be kept") {
  const Folder folder;
  {
    RunFolder before = folder.entered("a");
    folder.make(before, 0);
    before.write_manifest();
  }
  const Error refused = error_of([&] { folder.entered("b", Earlier::kept); });
  CHECK(refused.code() == ExitCode::input);
  CHECK(refused.what() ==
        folder.path.string() + ": --resume: it holds another run: its name differs: \"a\" there, \"b\" here");
  CHECK(folder.listed().size() == 1);
  const RunFolder after = folder.entered("b");
  CHECK_FALSE(after.whole(0));
  CHECK(names_in(folder.path) == std::set<std::string>{"pmd_0000.txt", "run.json"});
}

TEST_CASE("a run of which nothing was measured keeps nobody out") {
  const Folder folder;
  std::string text;
  {
    const RunFolder begun = folder.entered("a");
    text = content_of(folder.path / "run.json");
  }
  std::filesystem::create_directories(folder.path); // as a killed process leaves it
  std::ofstream(folder.path / "run.json") << text;
  const RunFolder after = folder.entered("b", Earlier::kept);
  CHECK(content_of(folder.path / "run.json") != text);
}

TEST_CASE("another run is refused while somebody is at one") {
  const Folder folder;
  RunFolder living = folder.entered("a");
  folder.make(living, 0);
  const Earlier earlier = GENERATE(Earlier::kept, Earlier::made_again);
  const Error refused = error_of([&] { folder.entered("b", earlier); });
  CHECK(refused.code() == ExitCode::output);
  const Beginner beginner = this_process();
  CHECK(refused.what() ==
        fmt::format("{}: another run is being written there, begun by process {} on {}: its "
                    "name differs: \"a\" there, \"b\" here",
                    folder.path.string(), beginner.process, beginner.host));
  CHECK(living.whole(0));
}

TEST_CASE("records without a run's file, and files that are none, are nobody's") {
  const Folder folder;
  std::filesystem::create_directory(folder.path);
  std::ofstream(folder.path / "0001.record.json") << R"({"frame": 1, "run": "a", "sensors": []})";
  std::ofstream(folder.path / "manifest.json") << "{}";
  const std::string text = GENERATE(as<std::string>(), "", "{", "{}", "[]",
                                    R"({"run": "a", "begun_by": {"host": "h", "process": 1}, "inputs": [3]})",
                                    std::string(100'000, '['),
                                    R"({"run": "a", "begun_by": {"host": "h", "process": 1}, "program": )" +
                                        std::string(100'000, '[') + std::string(100'000, ']') + "}",
                                    "none");
  if (text != "none")
    std::ofstream(folder.path / "run.json") << text;
  if (text != "none")
    CHECK(error_of([&] { folder.entered("a", Earlier::kept); }).code() == ExitCode::input);
  const RunFolder after = folder.entered("a", text == "none" ? Earlier::kept : Earlier::made_again);
  CHECK(names_in(folder.path) == std::set<std::string>{"run.json"});
}

TEST_CASE("a record counts while its files are there, each of its size, and it is a whole one") {
  const Folder folder;
  RunFolder run = folder.entered();
  folder.make(run, 7);
  REQUIRE(run.whole(7));
  const auto file = folder.path / "pmd_0007.txt", record = folder.path / "0007.record.json";
  const auto edit = [&](const std::function<void(nlohmann::json &)> &change) {
    nlohmann::json json = nlohmann::json::parse(content_of(record));
    change(json["sensors"][0]);
    std::ofstream(record) << json;
  };
  SECTION("a file has gone") { std::filesystem::remove(file); }
  SECTION("a file has grown") { std::ofstream(file, std::ios::app) << "x"; }
  SECTION("an empty record") { std::ofstream(record, std::ios::trunc); }
  SECTION("half a record") { std::filesystem::resize_file(record, 100); }
  SECTION("another run's") { std::ofstream(record) << R"({"frame": 7, "run": "b", "sensors": []})"; }
  SECTION("another frame's") { std::ofstream(record) << R"({"frame": 8, "run": "a", "sensors": []})"; }
  SECTION("without sensors") { std::ofstream(record) << R"({"frame": 7, "run": "a", "sensors": []})"; }
  SECTION("nested too deep") {
    const std::string before = R"({"frame": 7, "run": "a", "sensors": )";
    std::ofstream(record) << before << std::string(100'000, '[') << std::string(100'000, ']') << "}";
  }
  SECTION("without a time") {
    edit([](nlohmann::json &sensor) { sensor["manifest"].erase("time_s"); });
  }
  SECTION("without a name") {
    edit([](nlohmann::json &sensor) { sensor["manifest"].erase("sensor"); });
  }
  SECTION("sizes that are no list") {
    edit([](nlohmann::json &sensor) { sensor["bytes"] = {{"a", 1}}; });
  }
  SECTION("of another form") { std::ofstream(record) << R"({"frame": 7, "run": "a", "sensors": [{}]})"; }
  SECTION("of files that are no frame's, or elsewhere") {
    const std::string name =
        GENERATE("../out/pmd_0007.txt", "run.json", ".pmd_0007.txt", "pmd_0008.txt", "\x1b[2Jpmd_0007.txt");
    if (!std::filesystem::exists(folder.path / name))
      std::filesystem::copy_file(file, folder.path / name);
    edit([&](nlohmann::json &sensor) {
      sensor["manifest"]["outputs"][0] = name;
      sensor["bytes"][0] = std::filesystem::file_size(folder.path / name);
    });
  }
  SECTION("a file that is named twice") {
    edit([](nlohmann::json &sensor) {
      sensor["manifest"]["outputs"].push_back(sensor["manifest"]["outputs"][0]);
      sensor["bytes"].push_back(sensor["bytes"][0]);
    });
  }
  CHECK_FALSE(run.whole(7));
  folder.make(run, 7);
  CHECK(run.whole(7));
}

TEST_CASE("a record that is no regular file is refused, not waited for") {
  const Folder folder;
  RunFolder run = folder.entered();
  REQUIRE(::mkfifo((folder.path / "0007.record.json").c_str(), 0600) == 0);
  const Error refused = error_of([&] { run.whole(7); });
  CHECK(refused.code() == ExitCode::input);
  CHECK(refused.what() == (folder.path / "0007.record.json").string() + ": is no regular file");
}

TEST_CASE("where frames are to keep their promise, those that do not are not whole") {
  const Folder folder;
  RunFolder run = folder.entered();
  folder.make(run, 1);
  folder.make(run, 2);
  folder.make(run, 3);
  const auto edit = [&](const std::string &name, const char *part) {
    nlohmann::json json = nlohmann::json::parse(content_of(folder.path / name));
    json["sensors"][0][part]["unpromised"] = 5;
    std::ofstream(folder.path / name) << json;
  };
  edit("0002.record.json", "manifest");
  edit("0003.record.json", "told");
  const RunFolder strict(folder.path, run_named("a"), {0, 100}, Earlier::kept, never, true);
  CHECK(run.whole(2));
  CHECK(run.whole(3));
  CHECK(strict.whole(1));
  CHECK_FALSE(strict.whole(2));
  CHECK_FALSE(strict.whole(3));
}

TEST_CASE("a link in the place of the run's file is replaced, and what it leads to stays") {
  const pmdsim::test::TemporaryFolder elsewhere;
  const auto victim = elsewhere.write("victim", "its bytes");
  const Folder folder;
  std::filesystem::create_directory(folder.path);
  for (const std::filesystem::path &to :
       {std::filesystem::path("nothing"), victim, std::filesystem::path(".")})
    for (const char *name : {"run.json", "manifest.json", "0001.record.json"}) {
      std::filesystem::remove(folder.path / name);
      std::filesystem::create_symlink(to, folder.path / name);
      RunFolder run = folder.entered();
      folder.make(run, 1);
      run.write_manifest();
      for (const char *written : {"run.json", "manifest.json", "0001.record.json"})
        CHECK(std::filesystem::symlink_status(folder.path / written).type() ==
              std::filesystem::file_type::regular);
    }
  CHECK(std::filesystem::file_size(victim) == 9);
  CHECK_FALSE(std::filesystem::exists(elsewhere.path() / "nothing"));
}

TEST_CASE("waiting for another's manifest can be interrupted, and is not long where a run ends early") {
  const Folder folder;
  RunFolder run(folder.path, run_named("a"), {0, 100}, Earlier::made_again,
                [] { throw Error(ExitCode::interrupted, "interrupted"); });
  folder.make(run, 1);
  constexpr std::uint64_t writing_manifest = 1;
  {
    ByteLocks other(::open((folder.path / "run.json").c_str(), O_RDWR | O_CLOEXEC));
    REQUIRE(other.try_lock(writing_manifest, ByteLocks::Kind::exclusive));
    CHECK(error_of([&] { run.write_manifest(); }).code() == ExitCode::interrupted);
    CHECK_FALSE(run.keep_whole_frames());
  }
  CHECK(run.keep_whole_frames());
  CHECK(folder.listed() == std::vector{1});
}

TEST_CASE("temporary files go with the last who lives there, and nobody else's") {
  const Folder folder;
  std::filesystem::create_directory(folder.path);
  const std::set<std::string> leftovers{".pmd_0001.exr.0123abcd.partial",
                                        ".0001.record.json.0123abcd.partial",
                                        ".run.json.00000000.partial",
                                        ".manifest.json.ffffffff.partial",
                                        ".pmd.distance_m.sheet.png.0123abcd.partial",
                                        ".pmd.distance_m.apng.0123abcd.partial"};
  const std::set<std::string> others{".tradeoff.csv.0123abcd.partial", ".pmd_0001.exr.partial",
                                     ".pmd_0001.exr.0123abcx.partial", "pmd_0001.exr.0123abcd.partial"};
  const auto write_all = [&] {
    for (const auto &names : {leftovers, others})
      for (const std::string &name : names)
        std::ofstream(folder.path / name) << "half";
  };
  const auto there = [&](const std::set<std::string> &names) {
    const std::set<std::string> all = names_in(folder.path);
    return std::ranges::count_if(names, [&](const std::string &name) { return all.contains(name); });
  };
  write_all();
  {
    RunFolder first = folder.entered();
    CHECK(there(leftovers) == 0);
    write_all();
    {
      RunFolder second = folder.entered();
      CHECK(there(leftovers) == std::ssize(leftovers));
    }
    CHECK(there(leftovers) == std::ssize(leftovers));
    folder.make(first, 0);
  }
  CHECK(there(leftovers) == 0);
  CHECK(there(others) == 4);
}

TEST_CASE("without a whole frame a run leaves nothing, unless it has ended well") {
  const Folder folder;
  {
    RunFolder run = folder.entered();
    CHECK(run.claim(0) == Claim::granted);
    CHECK(run.keep_whole_frames());
  }
  CHECK_FALSE(std::filesystem::exists(folder.path));
  { folder.entered().write_manifest(); }
  CHECK(names_in(folder.path) == std::set<std::string>{"manifest.json", "run.json"});
}

TEST_CASE("the last frame's process removes nothing that another has made") {
  const Folder folder;
  {
    RunFolder first = folder.entered();
    {
      RunFolder second = folder.entered();
      folder.make(second, 1);
    }
    CHECK(first.keep_whole_frames());
  }
  CHECK(folder.listed() == std::vector{1});
}

TEST_CASE("a folder's own manifest is made again from its records") {
  const Folder folder;
  {
    RunFolder run = folder.entered();
    folder.make(run, 1);
    folder.make(run, 4);
  }
  CHECK_FALSE(std::filesystem::exists(folder.path / "manifest.json"));
  { CHECK(RunFolder::of_existing(folder.path, never).write_manifest() == 2); }
  CHECK(folder.listed() == std::vector{1, 4});
  CHECK(error_of([&] { RunFolder::of_existing(folder.temporary.path() / "none", never); }).code() ==
        ExitCode::input);
  CHECK_FALSE(std::filesystem::exists(folder.temporary.path() / "none"));
}

TEST_CASE("what differs between two runs is told by its place") {
  const auto of = [](nlohmann::ordered_json head) { return RunIdentity{std::move(head), "hash"}; };
  const auto setup = [&](int samples) {
    return of({{"version", "1"}, {"setup", {{"sensors", {{{"samples", 1}}, {{"samples", samples}}}}}}});
  };
  CHECK(difference_text(setup(2), setup(3)) == "the setup differs at /sensors/1/samples: 2 there, 3 here");
  CHECK(difference_text(of({{"setup", 3}}), of({{"setup", {1}}})) == "its setup differs: 3 there, [1] here");
  CHECK(difference_text(of({{"version", "1"}, {"a", 1}}), of({{"version", "2"}, {"a", 2}})) ==
        "its version differs: \"1\" there, \"2\" here");
  const auto inputs = [&](const std::string &hash) {
    return of(
        {{"inputs", {{{"file", "a.gltf"}, {"xxh3_128", "1"}}, {{"file", "b.bin"}, {"xxh3_128", hash}}}}});
  };
  CHECK(difference_text(inputs("1"), inputs("2")) == "the input file b.bin has changed");
  CHECK(difference_text(of({{"inputs", nlohmann::ordered_json::array()}}), inputs("1")) ==
        "the input file a.gltf was not read there");
  CHECK(difference_text(of({{"a", 1}}), of({{"a", 1}, {"b", 2}})) == "its b differs: nothing there, 2 here");
  CHECK(difference_text(of({{"a", 1}, {"b", 2}}), of({{"a", 1}})) == "its b differs: 2 there, nothing here");
}

TEST_CASE("a shard has the frames whose numbers leave its remainder") {
  const FrameRange all{3, 12};
  std::vector<std::uint32_t> frames;
  for (std::uint32_t index = 0; index < 4; ++index) {
    const FrameRange shard = Shard{index, 4}.of(all);
    for (std::uint32_t i = 0; i < shard.count(); ++i) {
      frames.push_back(shard.at(i));
      CHECK(shard.at(i) % 4 == index);
      CHECK(shard.contains(shard.at(i)));
      CHECK(shard.index_of(shard.at(i)) == i);
      CHECK_FALSE(shard.contains(shard.at(i) + 1));
    }
  }
  CHECK(frames == std::vector<std::uint32_t>{4, 8, 5, 9, 6, 10, 3, 7, 11});
  CHECK(Shard{}.of(all).count() == 9);
  CHECK(Shard{2, 8}.of({0, 2}).count() == 0);
  CHECK(Shard{0, 8}.of({5, 6}).count() == 0);
  CHECK(Shard{5, 8}.of({5, 6}).count() == 1);
  constexpr std::uint32_t many = 4294967295;
  CHECK(Shard{many - 1, many}.of({0, 10}).count() == 0);
  CHECK(Shard{7, many}.of({3, 10}).at(0) == 7);
  CHECK(Shard{7, many}.of({3, 10}).count() == 1);
  CHECK(Shard{2, many}.of({3, 10}).count() == 0);
}
