# Writes OUTPUT, the definition of nephele::buildIdentity(): a hash of the names and contents of SOURCES (separated by
# |, relative to ROOT). Run with cmake -P whenever one of them changes.
string(REPLACE "|" ";" sources "${SOURCES}")
list(SORT sources)
set(all "")
foreach(source IN LISTS sources)
  file(SHA256 ${ROOT}/${source} hash)
  string(APPEND all "${source} ${hash}\n")
endforeach()
string(SHA256 identity "${all}")
string(SUBSTRING ${identity} 0 32 identity)
file(WRITE ${OUTPUT} "#include \"bake/pipeline_identity.h\"
std::string_view nephele::buildIdentity() { return \"${identity}\"; }
")
