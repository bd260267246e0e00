// Verdicts as text and JSON. Depends on base and nlohmann_json.
#include "volume/check.h"

#include <algorithm>
#include <array>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/error.h"

namespace nephele {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::string_view, 3> kPrograms{"blender", "houdini", "unreal"};

std::string wordOf(Holds holds) {
  switch (holds) {
    case Holds::yes:
      return "yes";
    case Holds::note:
      return "note";
    case Holds::no:
      return "no";
    case Holds::notAsked:
      return "not asked";
  }
  return {};
}

}  // namespace

Audience audienceOf(const std::string& name) {
  if (name.empty()) return {};
  if (std::find(kPrograms.begin(), kPrograms.end(), name) == kPrograms.end())
    throw InputError({}, "no rules are known for '" + name + "'; there are blender, houdini and unreal",
                     didYouMean(name, kPrograms));
  return {name == kPrograms[0], name == kPrograms[1], name == kPrograms[2]};
}

bool FileCheck::good() const {
  return std::none_of(verdicts.begin(), verdicts.end(),
                      [](const Verdict& v) { return v.holds == Holds::no; });
}

FileCheck checkFile(const std::string& path, const Audience& audience) {
  return {path, verdictsOn(factsOf(path), audience)};
}

std::string checkAsText(const FileCheck& check) {
  constexpr int kNumber = 4, kWord = 9, kName = 15;
  std::ostringstream text;
  text << check.path << '\n';
  for (const Verdict& v : check.verdicts)
    text << std::right << std::setw(kNumber) << v.rule << "  " << std::left << std::setw(kWord)
         << (v.holds == Holds::notAsked ? "-" : wordOf(v.holds)) << "  " << std::setw(kName) << v.name << "  "
         << v.sentence << '\n';
  const auto count = [&](Holds holds) {
    return std::count_if(check.verdicts.begin(), check.verdicts.end(),
                         [&](const Verdict& v) { return v.holds == holds; });
  };
  text << "  " << (check.good() ? "good" : "not good") << ": " << count(Holds::yes) << " yes, "
       << count(Holds::note) << " with a note, " << count(Holds::no) << " no\n";
  return text.str();
}

std::string checksAsJson(const std::vector<FileCheck>& checks) {
  Json files = Json::array();
  for (const FileCheck& check : checks) {
    Json rules = Json::array();
    for (const Verdict& v : check.verdicts)
      rules.push_back(
          {{"rule", v.rule}, {"name", v.name}, {"holds", wordOf(v.holds)}, {"sentence", v.sentence}});
    files.push_back({{"path", check.path}, {"good", check.good()}, {"rules", rules}});
  }
  constexpr int kIndent = 2;
  // Names in foreign files need not be UTF-8.
  const Json& shown = files.size() == 1 ? files[0] : files;
  return shown.dump(kIndent, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace nephele
