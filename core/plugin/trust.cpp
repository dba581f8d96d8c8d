#include "core/plugin/trust.hpp"

#include <grp.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <vector>

#include "core/base/error.hpp"

namespace scree::core {
namespace {

/// A group with the user's own name and no other member: with it, writable by the group means writable by the user.
bool private_group(gid_t group) {
  if (group == 0) return true;
  std::vector<char> user_text(16384), group_text(16384);
  passwd user{};
  ::group entry{};
  passwd* found_user = nullptr;
  ::group* found_group = nullptr;
  if (getpwuid_r(geteuid(), &user, user_text.data(), user_text.size(), &found_user) != 0 || !found_user) return false;
  if (getgrgid_r(group, &entry, group_text.data(), group_text.size(), &found_group) != 0 || !found_group) return false;
  for (char** member = entry.gr_mem; *member; ++member)
    if (std::string(*member) != user.pw_name) return false;
  return std::string(user.pw_name) == entry.gr_name;
}

}  // namespace

void require_trusted(const std::filesystem::path& path) {
  struct stat info {};
  if (stat(path.c_str(), &info) != 0)
    throw Refusal(Exit::plugin, path.string() + ": cannot be read: " + std::generic_category().message(errno) +
                                    ": check the file and its permissions");
  const std::string what = S_ISDIR(info.st_mode) ? "this folder" : "this file";
  if (info.st_uid != 0 && info.st_uid != geteuid())
    throw Refusal(Exit::plugin, path.string() + ": " + what +
                                    " belongs to another user, who could change the code that would run here: copy it "
                                    "to a folder of your own and check it");
  if ((info.st_mode & S_IWOTH) != 0)
    throw Refusal(Exit::plugin, path.string() + ": everybody may write to " + what +
                                    ", so anybody could change the code that would run here: chmod o-w " +
                                    path.string());
  if ((info.st_mode & S_IWGRP) != 0 && !private_group(info.st_gid))
    throw Refusal(Exit::plugin, path.string() + ": a group may write to " + what +
                                    ", so others could change the code that would run here: chmod g-w " +
                                    path.string());
}

}  // namespace scree::core
