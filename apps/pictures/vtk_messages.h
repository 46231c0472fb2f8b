/// VTK's messages, kept for the one line that reports a failure.
#pragma once

#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>

#include <string>

namespace pcl_symmetry::apps {

/// Keeps VTK's messages for the one line that reports a failure.
class MessageCollector : public vtkOutputWindow {
public:
  static MessageCollector* New() { VTK_STANDARD_NEW_BODY(MessageCollector); }
  vtkTypeMacro(MessageCollector, vtkOutputWindow);
  void DisplayText(const char*) override {}
  void DisplayErrorText(const char* text) override {
    if (first_error.empty() && text) first_error = text;
  }
  void DisplayGenericWarningText(const char* text) override {
    if (first_warning.empty() && text) first_warning = text;
  }
  void DisplayWarningText(const char* text) override { DisplayGenericWarningText(text); }
  std::string first_error, first_warning;
};

/// Puts the collector in place of VTK's own window while something is read or drawn.
class VtkMessages {
public:
  VtkMessages() : old_(vtkOutputWindow::GetInstance()) {
    vtkOutputWindow::SetInstance(collector_);
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  }
  ~VtkMessages() { vtkOutputWindow::SetInstance(old_); }
  VtkMessages(const VtkMessages&) = delete;
  VtkMessages& operator=(const VtkMessages&) = delete;
  const std::string& firstError() const { return collector_->first_error; }
  const std::string& firstWarning() const { return collector_->first_warning; }

private:
  vtkSmartPointer<vtkOutputWindow> old_;
  vtkNew<MessageCollector> collector_;
};

}  // namespace pcl_symmetry::apps
