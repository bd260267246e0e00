// Reading fields out of YAML by the field table. Part of pipeline; depends on fields and base.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "bake/pipeline.h"
#include "base/yaml.h"

namespace nephele {

/// Reads the fields of one recipe: `fields:` by name, and nested ones wherever a field is expected. A field
/// is a map with one key (its name in the table), a number (constant), the name of a named field, or the name
/// of a row that needs no parameters. Nodes that aliases share are read once.
class FieldReader {
 public:
  /// Files that the recipe names lie relative to `folder`.
  FieldReader(Diagnostics& out, std::string folder) : out_(out), folder_(std::move(folder)) {}

  /// Takes the map of named fields; reads none of them yet.
  void setNamed(const yaml::Node& fields);
  /// Reads every named field that nothing asked for, so that their errors are told too.
  void readRest();
  /// The field, or nullptr after complaining.
  FieldSpecPtr read(const yaml::NodePtr& node, const std::string& what);
  /// The same field with named fields written out where they are used. `node` must be one that read() took.
  yaml::NodePtr withoutNames(const yaml::NodePtr& node) const;

 private:
  FieldSpecPtr readNew(const yaml::Node& node, const std::string& what);
  FieldSpecPtr readName(const yaml::Node& node, const std::string& what);
  FieldSpecPtr readNamed(const std::string& name, const SourceLocation& from);
  FieldSpecPtr readRow(const FieldRow& row, const yaml::Node& body, const SourceLocation& where);
  bool readParameter(const Parameter& parameter, const std::string& what, const yaml::NodePtr& node,
                     FieldSpec& spec);
  bool readFields(const Parameter& parameter, const std::string& what, const yaml::Node& node,
                  FieldSpec& spec);
  bool validate(const FieldRow& row, const FieldSpec& spec, const yaml::Node& body, Arguments::Given given);
  std::vector<std::string_view> knownNames() const;

  Diagnostics& out_;
  std::string folder_;
  std::map<std::string, yaml::NodePtr> named_;
  std::map<std::string, FieldSpecPtr> readNames_;
  int depth_ = 0;                  // fields being read, one in the other
  std::vector<std::string> path_;  // named fields being read, outermost first
  std::map<const yaml::Node*, FieldSpecPtr> readNodes_;
};

}  // namespace nephele
