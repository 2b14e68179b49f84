#include "db/attribution.h"

#include <algorithm>

#include "remomask/error.h"
#include "text/encoding.h"

namespace remomask::db {

namespace {

std::string attribution_key(const std::string& source) { return "attribution/" + source; }

}  // namespace

std::optional<std::string> attribution(const Database& database, const std::string& source) {
  const auto text = database.fact(attribution_key(source));
  // A fact cannot be removed, only emptied.
  return text && !text->empty() ? text : std::nullopt;
}

void set_attribution(Database& database, const std::string& source, const std::string& text) {
  if (!text::is_utf8(text)) throw Error("the attribution is not UTF-8; save it in that encoding");
  const auto clips = database.clips();
  if (std::none_of(clips.begin(), clips.end(),
                   [&](const Clip& clip) { return clip.source == source; })) {
    throw Error(database.path() + ": no clip is of the data set '" + source +
                "'; remomask db info lists the data sets");
  }
  database.set_fact(attribution_key(source), text);
}

void add_attribution(Database& database, const std::string& source, const std::string& text) {
  const std::string known = attribution(database, source).value_or("");
  if (known.find(text) != std::string::npos) return;
  set_attribution(database, source, known.empty() ? text : known + "\n" + text);
}

}  // namespace remomask::db
