// Sections of a stream's report.
#include "testbench/streaminggs/report/report_sections.h"

namespace sgs {
namespace {

void visit_times(ReportVisitor& r, const char* key, const MedianAndWorst& of,
                 const std::string& what) {
  r.object(key, [&] {
    r("median_s", "s", (what + ", of half of the frames at most.").c_str(), of.median_s);
    r("worst_s", "s", (what + ", of the frame that takes longest.").c_str(), of.worst_s);
  });
}

void visit_frame(ReportVisitor& r, std::size_t number, const StreamedPicture& frame) {
  const FrameTiming& t = frame.timing;
  r("frame", "", "Number of the frame, from 0.", number);
  r("pose_s", "s",
    "Time when its pose was measured: its number over `frame_rate`. Without a display `begun_s`.",
    t.pose_s);
  r("begun_s", "s", "Time when the machine took the pose.", t.begun_s);
  r("drawn_s", "s", "Time when its last pixel was in DRAM.", t.drawn_s);
  r("shown_s", "s", "Time when the display began to show it.", t.shown_s);
  r("time_s", "s", "From `begun_s` to `drawn_s`.", t.time_s());
  r("buffer_wait_s", "s",
    "Of it, the wait of its pixels for a buffer that the display still shows. Without a display 0.",
    t.buffer_wait_s);
  r("held", "bool",
    "It is shown in the picture behind that of the frame before it. If not, that one is repeated.",
    t.held);
  r("latency_s", "s",
    "Motion to photon: from `pose_s` to the light of the picture's middle row. No frame is left "
    "out, so one that misses delays all later ones.",
    t.latency_s);
  r("latched_late_s", "s",
    "The same from `begun_s`, as if the pose was measured then. Equal where a frame begins as its "
    "pose comes.",
    t.latched_late_s);
  r("psnr_db", "dB", "As `image.psnr_db`.", frame.psnr_db);
  r("ssim", "0..1", "As `image.ssim`.", frame.ssim);
  r.each(frame.right, [&](const StreamedPicture::Measures& right) {
    r("right_psnr_db", "dB", "As `image.right_eye.psnr_db`.", right.psnr_db);
    r("right_ssim", "0..1", "As `image.right_eye.ssim`.", right.ssim);
  });
  r("equals_streaming_renderer", "bool", "As `image.equals_streaming_renderer`.",
    frame.equals_golden);
  r("empty", "bool", "As `image.empty`.", frame.empty);
}

}  // namespace

void visit_stream(ReportVisitor& r, const StreamReport& stream) {
  const StreamSummary& s = stream.summary;
  r("frame_rate", "1/s", "Pictures a second: `--frame-rate`. 0: a frame is shown when it is drawn.",
    s.rate);
  r("frames_per_s", "1/s",
    "Frames a second from the first to the last that is shown; without a rate to the last but one, "
    "since behind the last none competes.",
    s.frames_per_s);
  visit_times(r, "frame_time", s.frame_time, "`frames[].time_s`");
  r.object("frame_time",
           [&] { r("p99_s", "s", "The same, of 99 of 100 frames at most.", s.frame_time_p99_s); });
  r("rest_s", "s", "Time in which no frame is under way, of all.", s.rest_s);
  r("worst_frame", "", "Number of the frame that takes longest, from 0.", s.worst_frame);
  r("missed_frames", "", "Frames that are not held.", s.missed.size());
  r("pictures", "", "Pictures that the display shows, from the first frame to the last.",
    s.pictures);
  r("repeated_pictures", "", "Of these, those for which no new frame was there.", s.repeated);
  r("rows_late", "", "Rows of pixels that the memory gave the display too late.", s.rows_late);
  visit_times(r, "latency", s.latency, "`frames[].latency_s`");
  visit_times(r, "latched_late", s.latched_late, "`frames[].latched_late_s`");
  r("least_wait_s", "s",
    "Least time that a frame waits in DRAM for its picture: so much later poses would do.",
    s.least_wait_s);
  r.object("flow", [&] { visit_flow(r, stream.flow); });
  std::size_t number = 0;
  r.list("frames", stream.frames,
         [&](const StreamedPicture& frame) { visit_frame(r, number++, frame); });
}

}  // namespace sgs
