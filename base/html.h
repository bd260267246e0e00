// The frame of a page that stands alone: what the charts of both programs share. Depends on base alone.
#pragma once

#include <string>

namespace nephele {

/// With &, < and > as entities.
std::string htmlEscaped(const std::string& text);

/// A whole page: doctype, style, the title as heading, then `body`, which is taken as it is.
std::string htmlPage(const std::string& title, const std::string& body);

}  // namespace nephele
