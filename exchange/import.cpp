#include "exchange/import.h"

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>

#include "db/lost_captions.h"
#include "db/transaction.h"
#include "exchange/archive.h"
#include "exchange/humanml_folder.h"
#include "exchange/motion_folder.h"
#include "exchange/ordered_work.h"
#include "formats/unread_formats.h"
#include "remomask/error.h"

namespace remomask::exchange {

namespace {

namespace fs = std::filesystem;

/// A kill loses at most so many files.
constexpr int kFilesInBatch = 64;

/// What a worker makes of one file.
struct ReadFile {
  std::string fingerprint;
  bool known = false;
  std::string rejection;
  std::vector<std::string> warnings;
  std::vector<PreparedClip> clips;
};

/// Messages name files as they are called in the data set: the folder may be a
/// temporary one.
std::string without_folder(std::string text, const std::string& folder) {
  const std::string prefix = folder + "/";
  for (size_t at = text.find(prefix); at != std::string::npos; at = text.find(prefix, at)) {
    text.erase(at, prefix.size());
  }
  return text;
}

ReadFile read_source_file(const MotionSource& source, size_t i,
                          const std::map<std::string, std::string>& imported) {
  ReadFile file;
  try {
    file.fingerprint = source.fingerprint(i);
    const auto note = imported.find(source.files()[i].key);
    file.known = note != imported.end() && note->second == file.fingerprint;
    if (!file.known) file.clips = source.prepare(i, file.warnings);
  } catch (const Error& error) {
    file.rejection = error.what();
  } catch (const std::exception& error) {
    // One odd file must not end the import of thousands.
    file.rejection = std::string("cannot be read: ") + error.what();
  }
  return file;
}

/// Stores what the workers read, in batches, and keeps the report.
class ImportWriter {
 public:
  ImportWriter(db::Database& database, const MotionSource& source, const Monitor& monitor)
      : database_(database), source_(source), monitor_(monitor) {
    for (const SourceFile& file : source.files()) total_bytes_ += file.bytes;
    report_.files = static_cast<int>(source.files().size());
    for (const std::string& warning : source.warnings()) add_warning(warning);
    batch_.emplace(database_);
  }

  void store(size_t i, ReadFile&& file) {
    const SourceFile& place = source_.files()[i];
    report_.bytes_read += place.bytes;
    for (const std::string& warning : file.warnings) add_warning(warning);
    if (file.known) {
      ++report_.files_known;
    } else if (!file.rejection.empty()) {
      reject(place.name, file.rejection);
    } else {
      store_clips(place, file);
    }
    show(i + 1);
    if (monitor_.stop_requested()) {
      close();
      throw Interrupted("the import of " + source_.options().source + " was stopped after " +
                        std::to_string(i + 1) + " of " + std::to_string(report_.files) +
                        " files; they are stored. Run the same import again to go on");
    }
    if (++in_batch_ >= kFilesInBatch) {
      batch_->commit();
      batch_.emplace(database_);
      in_batch_ = 0;
    }
  }

  void close() { batch_->commit(); }

  ImportReport& report() { return report_; }

 private:
  void store_clips(const SourceFile& place, const ReadFile& read) {
    const std::string& file = place.name;
    const std::string& source = source_.options().source;
    // An older content or description of the same file gives way.
    const int removed = database_.remove_clips(source, place.key);
    if (removed > 0) {
      add_warning(file + ": the file, its description or the options changed; its " +
                  std::to_string(removed) + " clips of an earlier import were replaced");
    }
    for (const PreparedClip& item : read.clips) {
      if (const auto taken = database_.find_name(item.clip.name)) {
        reject(file, "the name '" + item.clip.name + "' is taken by a clip of '" +
                         database_.clip(*taken).source + "'; rename the file");
        return;
      }
    }
    int stored = 0;
    std::vector<std::pair<const db::Clip*, db::Clip>> duplicates;
    for (const PreparedClip& item : read.clips) {
      if (const auto same = database_.find_content(item.clip.content_hash)) {
        duplicates.emplace_back(&item.clip, database_.clip(*same));
      } else {
        database_.add_clip(item.clip, item.motion);
        ++stored;
      }
    }
    refuse_duplicates(file, duplicates, stored == 0);
    if (stored == 0) return;
    ++report_.files_stored;
    report_.clips_stored += stored;
    if (read.clips.size() > 1) report_.clips_windowed += stored;
    database_.note_imported_file(source, place.key, read.fingerprint,
                                 std::to_string(stored) + " clips");
  }

  /// `all`: nothing of the file is new, so that it is refused as a whole.
  void refuse_duplicates(const std::string& file,
                         const std::vector<std::pair<const db::Clip*, db::Clip>>& duplicates,
                         bool all) {
    std::string twins;
    for (const auto& [clip, same] : duplicates) {
      const std::string twin = "'" + same.name + "' of '" + same.source + "'";
      twins += (twins.empty() ? "" : ", ") + twin;
      if (!all) reject(file + " (" + clip->name + ")", "is the same motion as " + twin);
      const std::string lost = db::lost_captions_warning(*clip, same);
      if (!lost.empty()) add_warning(file + ": " + lost);
    }
    if (all) reject(file, "is the same motion as " + twins);
  }

  void reject(const std::string& file, const std::string& reason) {
    std::string text = without_folder(reason, source_.options().folder);
    // The report names the file already.
    if (text.starts_with(file + ": ")) text.erase(0, file.size() + 2);
    report_.rejected.push_back({file, text});
  }

  void add_warning(const std::string& warning) {
    report_.warnings.push_back(without_folder(warning, source_.options().folder));
  }

  void show(size_t files_done) const {
    monitor_.report(
        {"import " + source_.options().source, 1e-6 * static_cast<double>(report_.bytes_read),
         1e-6 * static_cast<double>(total_bytes_),
         "MB, " + std::to_string(files_done) + " of " + std::to_string(report_.files) + " files"});
  }

  db::Database& database_;
  const MotionSource& source_;
  const Monitor& monitor_;
  ImportReport report_;
  uint64_t total_bytes_ = 0;
  int in_batch_ = 0;
  std::optional<db::Transaction> batch_;
};

void check_import_options(const ImportOptions& options) {
  if (options.threads < 1) throw Error("an import needs at least one thread");
  clip_windows(1, {options.min_frames, options.max_frames, options.window_overlap});
  if (!options.captions_file.empty() && !fs::exists(options.captions_file)) {
    throw Error(options.captions_file + ": there is no such captions file; check the path");
  }
}

std::unique_ptr<MotionSource> open_motion_source(ImportOptions options, const std::string& beside) {
  if (HumanmlFolder::is_layout_of(options.folder)) return std::make_unique<HumanmlFolder>(options);
  if (options.captions_file.empty()) {
    const std::string inside = (fs::path(options.folder) / "captions.jsonl").string();
    if (fs::exists(beside)) {
      options.captions_file = beside;
    } else if (fs::exists(inside)) {
      options.captions_file = inside;
    }
  }
  return std::make_unique<MotionFolder>(options);
}

}  // namespace

ImportReport import_folder(db::Database& database, const ImportOptions& options,
                           const Monitor& monitor) {
  check_import_options(options);
  const auto start = std::chrono::steady_clock::now();
  ImportOptions resolved = options;
  std::optional<UnpackedArchive> archive;
  std::string name, captions_beside;
  if (is_archive_name(options.folder)) {
    archive.emplace(options.folder, monitor);
    resolved.folder = archive->folder();
    name = archive_stem(options.folder);
    captions_beside = (fs::path(options.folder).parent_path() / (name + ".jsonl")).string();
  } else {
    if (!fs::is_directory(options.folder)) {
      throw Error(options.folder + ": is neither a folder nor a tar archive; check the path");
    }
    // Without a trailing slash or dots, so that it has a name.
    const fs::path folder = fs::canonical(options.folder);
    resolved.folder = folder.string();
    name = folder.filename().string();
    captions_beside = folder.string() + ".jsonl";
  }
  if (resolved.source.empty()) resolved.source = name;

  const auto source = open_motion_source(resolved, captions_beside);
  if (source->files().empty()) {
    throw Error(options.folder + ": holds no motion file (" + formats::readable_extensions() +
                "); check the path");
  }
  const auto imported = database.imported_files(resolved.source);
  ImportWriter writer(database, *source, monitor);
  work_in_order<ReadFile>(
      source->files().size(), options.threads,
      [&](size_t i) { return read_source_file(*source, i, imported); },
      [&](size_t i, ReadFile&& file) { writer.store(i, std::move(file)); });
  writer.close();
  if (!fs::exists(resolved.folder)) {
    throw Error(options.folder + ": was removed while it was imported; " +
                std::to_string(writer.report().files_stored) +
                " of its files were stored. Put it back and run the same import again");
  }
  writer.report().seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return writer.report();
}

}  // namespace remomask::exchange
