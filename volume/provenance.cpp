// The name that baked files carry. Depends on base.
#include "volume/provenance.h"

#include "base/version.h"

namespace nephele {

std::string creatorName() { return std::string("Nephele ").append(programVersion()); }

}  // namespace nephele
