#include "db/merge.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <tuple>

#include "db/attribution.h"
#include "db/lost_captions.h"
#include "db/transaction.h"
#include "remomask/error.h"

namespace remomask::db {

namespace {

constexpr size_t kEmbeddingsAtOnce = 256;

using FileKey = std::pair<std::string, std::string>;  // source, source_file

/// `name`, or the first of name#db2, name#db3, ... that `is_taken` does not know.
template <typename IsTaken>
std::string free_name(const std::string& name, IsTaken is_taken) {
  std::string candidate = name;
  for (int number = 2; is_taken(candidate); ++number) {
    candidate = name + "#db" + std::to_string(number);
  }
  return candidate;
}

/// True when labels of the data set, not the name of a file, made the group: it
/// means the same in every database.
bool labels_name_group(const Clip& clip) {
  const auto is_label = [&](const char* key, const std::string& prefix) {
    const auto label = clip.labels.find(key);
    return label != clip.labels.end() && label->is_string() &&
           prefix + label->get<std::string>() == clip.group;
  };
  return is_label("trial", "trial/") || is_label("duplicate_of", "");
}

class Merger {
 public:
  Merger(Database& target, const Database& other) : target_(target), other_(other) {
    const auto stored = target.clips();
    incoming_ = other.clips();
    report_.clips = static_cast<int64_t>(incoming_.size());
    for (const Clip& clip : stored) {
      names_.insert(clip.name);
      files_.insert({clip.source, clip.source_file});
      by_hash_.emplace(clip.content_hash, clip);
      group_splits_.emplace(clip.group, clip.split);
    }
    for (const Clip& clip : incoming_) incoming_names_.insert(clip.name);
    match_groups(stored);
    match_files();
  }

  void store_clips(const Monitor& monitor) {
    for (const Clip& clip : incoming_) {
      if (monitor.stop_requested()) {
        throw Interrupted("the merge was stopped; nothing was stored");
      }
      store(clip);
      monitor.report({"merge " + other_.path(), static_cast<double>(++done_),
                      static_cast<double>(incoming_.size()), ""});
    }
  }

  /// So that an import of the same files knows them here as it did there.
  void store_notes() {
    for (const auto& [source, file] : added_files_) {
      if (file_names_.at({source, file}) != file) continue;
      const auto known = target_.imported_files(source);
      const auto notes = other_.imported_files(source);
      const auto note = notes.find(file);
      if (note != notes.end() && !known.contains(file)) {
        target_.note_imported_file(source, file, note->second, "merged");
      }
    }
  }

  void store_embeddings() {
    for (const std::string& retriever : other_.retrievers()) {
      std::vector<int64_t> ids;
      for (const int64_t id : other_.embedded_clips(retriever)) {
        if (new_ids_.contains(id)) ids.push_back(id);
      }
      for (size_t first = 0; first < ids.size(); first += kEmbeddingsAtOnce) {
        const size_t last = std::min(ids.size(), first + kEmbeddingsAtOnce);
        auto embeddings =
            other_.embeddings(retriever, {ids.begin() + static_cast<ptrdiff_t>(first),
                                          ids.begin() + static_cast<ptrdiff_t>(last)});
        for (ClipEmbedding& embedding : embeddings) {
          embedding.clip_id = new_ids_.at(embedding.clip_id);
        }
        target_.add_embeddings(retriever, embeddings);
        report_.embeddings += static_cast<int64_t>(embeddings.size());
      }
    }
  }

  /// Those that no caption here needs go with the next index command.
  void store_caption_vectors() {
    for (const std::string& encoder : other_.caption_encoders()) {
      target_.add_caption_vectors(encoder, other_.caption_vectors(encoder));
    }
  }

  void store_attributions() {
    std::set<std::string> sources;
    for (const auto& [source, file] : added_files_) sources.insert(source);
    for (const std::string& source : sources) {
      if (const auto text = attribution(other_, source)) add_attribution(target_, source, *text);
    }
  }

  MergeReport report() && { return std::move(report_); }

 private:
  /// Under which name each group of the other database is stored.
  void match_groups(const std::vector<Clip>& stored) {
    std::set<std::string> taken, named_by_labels;
    for (const Clip& clip : stored) {
      taken.insert(clip.group);
      if (labels_name_group(clip)) named_by_labels.insert(clip.group);
    }
    for (const Clip& clip : incoming_) {
      if (labels_name_group(clip)) named_by_labels.insert(clip.group);
      const auto same = by_hash_.find(clip.content_hash);
      if (same != by_hash_.end()) group_names_.emplace(clip.group, same->second.group);
    }
    std::set<std::string> own;
    for (const Clip& clip : incoming_) own.insert(clip.group);
    for (const std::string& group : own) {
      if (group_names_.contains(group)) continue;
      const bool joined = named_by_labels.contains(group);
      const std::string name = free_name(group, [&](const std::string& candidate) {
        return candidate == group ? !joined && taken.contains(group)
                                  : taken.contains(candidate) || own.contains(candidate);
      });
      taken.insert(name);
      group_names_.emplace(group, name);
    }
  }

  /// A file of the same data set and name that is stored already is another
  /// file, unless they share a motion: an import that replaces the clips of one
  /// must not touch those of the other.
  void match_files() {
    std::set<FileKey> own, shared;
    for (const Clip& clip : incoming_) {
      own.insert({clip.source, clip.source_file});
      const auto same = by_hash_.find(clip.content_hash);
      if (same != by_hash_.end() && same->second.source == clip.source &&
          same->second.source_file == clip.source_file) {
        shared.insert({clip.source, clip.source_file});
      }
    }
    for (const FileKey& key : own) {
      file_names_[key] = free_name(key.second, [&](const std::string& candidate) {
        if (candidate == key.second) return !shared.contains(key) && files_.contains(key);
        const FileKey renamed{key.first, candidate};
        return files_.contains(renamed) || own.contains(renamed);
      });
    }
  }

  void store(const Clip& original) {
    if (const auto same = by_hash_.find(original.content_hash); same != by_hash_.end()) {
      report_.duplicates.emplace_back(original.name, same->second.name);
      const std::string lost = lost_captions_warning(original, same->second);
      if (!lost.empty()) report_.warnings.push_back(original.name + ": " + lost);
      return;
    }
    Clip clip = original;
    clip.name = free_name(original.name, [&](const std::string& candidate) {
      return names_.contains(candidate) ||
             (candidate != original.name && incoming_names_.contains(candidate));
    });
    if (clip.name != original.name) report_.renamed.emplace_back(original.name, clip.name);
    clip.group = group_names_.at(original.group);
    const FileKey key{original.source, original.source_file};
    clip.source_file = file_names_.at(key);
    warn_of_split(clip);
    new_ids_[original.id] = target_.add_clip(clip, other_.motion(original.id));
    names_.insert(clip.name);
    added_files_.insert(key);
    ++report_.added;
  }

  void warn_of_split(const Clip& clip) {
    const auto known = group_splits_.find(clip.group);
    if (known == group_splits_.end() || known->second == clip.split) return;
    report_.warnings.push_back(clip.name + ": is of split " + clip.split + ", but group '" +
                               clip.group + "' was of split " + known->second +
                               ": set one of them, or a test would see motions of the training");
  }

  Database& target_;
  const Database& other_;
  MergeReport report_;
  std::vector<Clip> incoming_;
  std::set<std::string> names_, incoming_names_;
  std::set<FileKey> files_, added_files_;
  std::map<std::string, Clip> by_hash_;              // stored before
  std::map<std::string, std::string> group_splits_;  // of a clip stored before
  std::map<std::string, std::string> group_names_;   // there -> here
  std::map<FileKey, std::string> file_names_;        // there -> here
  std::map<int64_t, int64_t> new_ids_;               // there -> here
  int64_t done_ = 0;
};

}  // namespace

MergeReport merge_database(Database& target, const Database& other, const Monitor& monitor) {
  if (std::filesystem::equivalent(target.path(), other.path())) {
    throw Error(target.path() + ": cannot be merged with itself; name another database");
  }
  const ReadSnapshot snapshot(other);
  Transaction transaction(target);
  Merger merger(target, other);
  merger.store_clips(monitor);
  merger.store_notes();
  merger.store_attributions();
  merger.store_embeddings();
  merger.store_caption_vectors();
  transaction.commit();
  return std::move(merger).report();
}

}  // namespace remomask::db
