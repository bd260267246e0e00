// Pages. Depends on html.h.
#include "base/html.h"

namespace nephele {

std::string htmlEscaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else
      out += c;
  }
  return out;
}

std::string htmlPage(const std::string& title, const std::string& body) {
  return "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>" + htmlEscaped(title) +
         "</title><style>body{font:15px sans-serif;margin:2em;max-width:1500px}td,th{padding:2px "
         "10px;text-align:left}"
         "img{image-rendering:pixelated;width:256px}.knee{font-weight:bold}figure{display:inline-block;"
         "margin:8px}</style><h1>" +
         htmlEscaped(title) + "</h1>\n" + body + "</html>\n";
}

}  // namespace nephele
