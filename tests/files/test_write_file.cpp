// SPDX-License-Identifier: BSD-3-Clause
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <csignal>
#include <set>

#include "given/files.hpp"
#include "mmbrdf/files/model_file.hpp"
#include "mmbrdf/files/samples_file.hpp"
#include "mmbrdf/files/write_file.hpp"

namespace mmbrdf {
namespace {

namespace fs = std::filesystem;

TEST(Files, ThatCannotBeReadAreNamedInOneLine) {
  const Folder folder;
  EXPECT_TRUE(
      says(complaint([&] { load_model(folder / "none.json"); }), {"none.json: cannot be opened: No such file"}));
  EXPECT_TRUE(
      says(complaint([&] { read_samples(folder / "none.csv"); }), {"none.csv: cannot be opened: No such file"}));
  EXPECT_TRUE(says(complaint([&] { load_model(folder / ""); }), {"is a folder"}));
  EXPECT_TRUE(says(complaint([&] { read_samples(folder / ""); }), {"is a folder"}));
  put(folder / "empty", "");
  EXPECT_TRUE(says(complaint([&] { load_model(folder / "empty"); }), {"empty: empty file"}));
  put(folder / "image.png", "\x89PNG\r\n\x1a\n");
  EXPECT_TRUE(says(complaint([&] { load_model(folder / "image.png"); }), {"image.png:1: ", "'\\x89PNG'"}));
  put(folder / "binary", "1, 1, 0, 0, 0, 0, 0, 2.5\n\x7f");
  EXPECT_TRUE(says(complaint([&] { load_model(folder / "binary"); }), {"binary:2: ", "'\\x7f'"}));
  EXPECT_TRUE(says(complaint([&] { load_model("/dev/zero"); }), {"/dev/zero: binary file"}));
  EXPECT_TRUE(says(complaint([&] { read_samples("/dev/zero"); }), {"/dev/zero:1: more than 65535 characters"}));
}

TEST(Files, AppearWhole) {
  const Folder folder;
  write_file(folder / "a", [&](std::ostream& out) {
    out << "first half, " << std::flush;
    EXPECT_FALSE(fs::exists(folder / "a"));
    out << "second half";
  });
  EXPECT_EQ(contents(folder / "a"), "first half, second half");
  EXPECT_EQ(folder.files(), 1);
}

TEST(Files, AreWrittenInOrderWhateverTheSizeOfThePieces) {
  const Folder folder;
  std::string expected;
  write_file(folder / "a", [&](std::ostream& out) {
    for (const std::size_t size : {1u, 65535u, 65536u, 65537u, 10u, 300000u, 0u, 65536u, 5u}) {
      const std::string piece(size, static_cast<char>('a' + expected.size() % 26));
      out << piece;
      expected += piece;
    }
  });
  EXPECT_EQ(contents(folder / "a"), expected);
}

TEST(Files, CanBeginWithWhatIsKnownAtTheEnd) {
  const Folder folder;
  write_file(folder / "a", [&](std::ostream& out) {
    out << "rows: ?\n" << std::string(100000, '.');
    out.seekp(0);
    out << "rows: 7";
  });
  EXPECT_EQ(contents(folder / "a"), "rows: 7\n" + std::string(100000, '.'));
}

TEST(Files, AreLeftAsTheyWereByAnErrorOnTheWay) {
  const Folder folder;
  put(folder / "a", "old");
  const auto half = [](std::ostream& out) {
    out << std::string(200000, 'x');
    throw std::runtime_error("d.csv:7: wrong");
  };
  EXPECT_EQ(complaint([&] { write_file(folder / "a", half); }), "d.csv:7: wrong");
  EXPECT_EQ(complaint([&] { write_file(folder / "b", half); }), "d.csv:7: wrong");
  EXPECT_EQ(contents(folder / "a"), "old");
  EXPECT_EQ(folder.files(), 1);
}

// A limit on the size of files stands for a full disc: write() fails in the middle in both cases.
TEST(Files, AreLeftAsTheyWereIfThereIsNoRoom) {
  const Folder folder;
  put(folder / "a", "old");
  rlimit usual;
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &usual), 0);
  const rlimit small{100000, usual.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string message =
      complaint([&] { write_file(folder / "a", [](std::ostream& out) { out << std::string(200000, 'x'); }); });
  ::setrlimit(RLIMIT_FSIZE, &usual);
  std::signal(SIGXFSZ, handler);
  EXPECT_TRUE(says(message, {folder / "a" + ": cannot be written: File too large"}));
  EXPECT_EQ(contents(folder / "a"), "old");
  EXPECT_EQ(folder.files(), 1);
}

// Only root can make a device, and only root could do harm to /dev/full.
TEST(Files, OnAFullDiscAreReported) {
  const Folder folder;
  const bool root = ::geteuid() == 0;
  const std::string full = root ? folder / "full" : "/dev/full";
  if (root && ::mknod(full.c_str(), S_IFCHR | 0666, ::makedev(1, 7)) != 0)
    GTEST_SKIP() << "skipped: no device can be made";
  if (::access(full.c_str(), W_OK) != 0) GTEST_SKIP() << "skipped: there is no device that is always full";
  EXPECT_EQ(complaint([&] { write_file(full, [](std::ostream& out) { out << "x"; }); }),
            full + ": cannot be written: No space left on device");
  EXPECT_TRUE(fs::is_character_file(full));
}

TEST(Files, InAFolderThatDoesNotExistAreReported) {
  const Folder folder;
  const auto nothing = [](std::ostream&) {};
  EXPECT_TRUE(says(complaint([&] { write_file(folder / "none/a", nothing); }),
                   {"none/a: cannot be written: there is no folder " + (folder / "none")}));
  EXPECT_TRUE(says(complaint([&] { write_file(folder / "", nothing); }), {"cannot be written: Is a directory"}));
  EXPECT_TRUE(says(complaint([&] { write_file("", nothing); }), {"cannot be written: it has no name"}));
}

TEST(Files, KeepPermissionsAndLinks) {
  const Folder folder;
  const auto write = [](std::ostream& out) { out << "new"; };
  const mode_t usual = ::umask(027);
  write_file(folder / "fresh", write);
  ::umask(usual);
  EXPECT_EQ(static_cast<unsigned>(fs::status(folder / "fresh").permissions()), 0640U);
  put(folder / "shared", "old");
  fs::permissions(folder / "shared", static_cast<fs::perms>(0664));
  fs::create_symlink("shared", folder / "link");
  fs::create_symlink("absent", folder / "dangling");
  write_file(folder / "link", write);
  write_file(folder / "dangling", write);
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(contents(folder / "shared"), "new");
  EXPECT_EQ(contents(folder / "absent"), "new");
  EXPECT_EQ(static_cast<unsigned>(fs::status(folder / "shared").permissions()), 0664U);
}

TEST(Files, AreReplacedWhereverTheyLie) {
  const Folder folder;
  const fs::path shared = fs::path("/dev/shm") / ("mmbrdf-test-" + std::to_string(::getpid()));
  std::vector<std::string> paths = {"/proc/self/cwd/" + fs::relative(folder / "a").string()};
  if (::access("/dev/shm", W_OK) == 0) paths.push_back(shared.string());
  for (const std::string& path : paths) {
    write_file(path, [](std::ostream& out) { out << "a longer, old text"; });
    complaint([&] { write_file(path, [](std::ostream&) { throw std::runtime_error(""); }); });
    EXPECT_EQ(contents(path), "a longer, old text") << path;
    write_file(path, [](std::ostream& out) { out << "new"; });
    EXPECT_EQ(contents(path), "new") << path;
  }
  fs::remove(shared);
}

// As the shell's `mmbrdf ... -o /dev/stdout > file`: whoever holds the file goes on with it.
TEST(Files, ThatAreHeldOpenAreWrittenToUnderTheNamesOfTheirDescriptors) {
  const Folder folder;
  const int held = ::open((folder / "a").c_str(), O_WRONLY | O_CREAT, 0600);
  const auto line = [](std::ostream& out) { out << "line\n"; };
  write_file("/dev/fd/" + std::to_string(held), line);
  fs::create_symlink("/proc/self/fd/" + std::to_string(held), folder / "link");
  write_file(folder / "link", line);
  EXPECT_EQ(contents(folder / "a"), "line\nline\n");
  write_file(folder / "link", [](std::ostream& out) {
    EXPECT_FALSE(out.seekp(0));
    out.clear();
  });
  ::close(held);
}

TEST(Files, OnALoopOfLinksAreRefused) {
  const Folder folder;
  fs::create_symlink("b", folder / "a");
  fs::create_symlink("a", folder / "b");
  EXPECT_TRUE(says(complaint([&] { write_file(folder / "a", [](std::ostream&) {}); }),
                   {"a: cannot be written: Too many levels of symbolic links"}));
  EXPECT_TRUE(fs::is_symlink(folder / "a"));
  EXPECT_EQ(folder.files(), 2);
}

TEST(Files, AreReplacedUnderOneNameOfSeveral) {
  const Folder folder;
  put(folder / "a", "old");
  fs::create_hard_link(folder / "a", folder / "other");
  write_file(folder / "a", [](std::ostream& out) { out << "new"; });
  EXPECT_EQ(contents(folder / "a"), "new");
  EXPECT_EQ(contents(folder / "other"), "old");
}

TEST(Files, ThatBelongTogetherAreReplacedTogether) {
  const Folder folder;
  put(folder / "a", "old a");
  put(folder / "b", "old b");
  const auto text = [](const std::string& words) { return [words](std::ostream& out) { out << words; }; };
  const auto fails = [](std::ostream&) { throw std::runtime_error("wrong"); };
  EXPECT_EQ(complaint([&] { write_files({{folder / "a", text("new a")}, {folder / "b", fails}}); }), "wrong");
  EXPECT_EQ(contents(folder / "a"), "old a");
  EXPECT_EQ(contents(folder / "b"), "old b");
  write_files({{folder / "a", text("new a")}, {folder / "b", text("new b")}, {folder / "c", text("new c")}});
  EXPECT_EQ(contents(folder / "a") + contents(folder / "b") + contents(folder / "c"), "new anew bnew c");
  EXPECT_EQ(folder.files(), 3);
}

TEST(Files, OfWhichTwoHaveOnePlaceAreRefused) {
  const Folder folder;
  put(folder / "a", "old");
  fs::create_symlink("a", folder / "b");
  const auto text = [](std::ostream& out) { out << "new"; };
  EXPECT_NE(complaint([&] {
              write_files({{folder / "a", text}, {folder / "b", text}});
            }).find("has this place"),
            std::string::npos);
  EXPECT_EQ(contents(folder / "a"), "old");
}

TEST(Files, ThatBelongTogetherAreAllPutBackIfOneCannotBePutInPlace) {
  const Folder folder;
  put(folder / "a", "old a");
  std::set<fs::path> before;
  const auto write = [&](std::ostream& out) {
    out << "new";
    for (const auto& file : fs::directory_iterator(folder / "")) before.insert(file);
  };
  const auto loses_its_file = [&](std::ostream&) {
    for (const auto& file : fs::directory_iterator(folder / ""))
      if (!before.contains(file)) fs::remove(file);
  };
  EXPECT_TRUE(says(complaint([&] {
                     write_files({{folder / "a", write}, {folder / "b", write}, {folder / "c", loses_its_file}});
                   }),
                   {"c: cannot be written: No such file"}));
  EXPECT_EQ(contents(folder / "a"), "old a");
  EXPECT_EQ(folder.files(), 1);
}

// What a handler of a signal does: temporary files are gone, all else stays.
TEST(Files, ThatWaitCanBeRemovedAtOnce) {
  const Folder folder;
  put(folder / "a", "old");
  EXPECT_NE(complaint([&] {
              write_file(folder / "a", [&](std::ostream& out) {
                out << "half" << std::flush;
                EXPECT_EQ(folder.files(), 2);
                remove_temporary_files();
                EXPECT_EQ(folder.files(), 1);
              });
            }),
            "");
  EXPECT_EQ(contents(folder / "a"), "old");
}

TEST(Files, ThatArePipesAreWrittenToAndStay) {
  const Folder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  const int reader = ::open((folder / "pipe").c_str(), O_RDONLY | O_NONBLOCK);
  write_file(folder / "pipe", [](std::ostream& out) { out << "through"; });
  char text[8] = {};
  EXPECT_EQ(::read(reader, text, sizeof text), 7);
  EXPECT_STREQ(text, "through");
  EXPECT_TRUE(fs::is_fifo(folder / "pipe"));
  ::close(reader);
}

}  // namespace
}  // namespace mmbrdf
